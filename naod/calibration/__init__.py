"""One head's camera: how it sits and how it maps, from a rectangle seen in many head poses."""
