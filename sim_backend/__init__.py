"""A simulated NAO in a simulated room, behind the interfaces of `hal.protocols`.

pybullet holds the robot's body, a ray caster of our own takes the pictures. Nothing here knows
what the robot is used for.
"""

from hal.kernel_cache import use_own_cache

use_own_cache()
