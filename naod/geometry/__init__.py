"""Rigid transforms and pinhole cameras.

T_a_b maps coordinates in b to coordinates in a: p_a = T_a_b p_b, and T_a_c = T_a_b T_b_c.
Frames: world, odom, base (between the feet, x forward, z up), torso, head, camera (optical: x
right, y down, z forward), object (x right, y up along it, z out of its face), goal (the base
frame where the robot is to stand).
"""
