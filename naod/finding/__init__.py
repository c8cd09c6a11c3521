"""Which regions of a mask are the object, and whether it is in the picture at all."""
