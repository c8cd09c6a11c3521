"""The object's pose in the camera's frame, from its outline: exact, and as the paper prints it."""
