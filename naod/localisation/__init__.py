"""Where the object is relative to the body: kinematics, base frame, ego-cylinder."""
