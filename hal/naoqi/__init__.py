"""A NAO with its stock system, through the `qi` package: V4, V5 and V6.

`robot.open_robot` opens it. `session` is the only room that touches `qi`. Three threads poll, each
over a session of its own, so that none waits for another: `body` the joints and the memory, `walk`
the motion, `camera` the pictures. `guard` is the walk's watchdog, in a process of its own.

A V4 is told as "v5": it has the same body and cameras.

What is done to the robot, and when:

- at start: Autonomous Life and its helpers are switched off, the camera is locked for colour work.
  Nothing is stiffened and nothing moves.
- at the first turn of the head with limp motors: the head, and only the head, is stiffened.
- at the first walk asked for while the robot rests or does not stand: it is woken up and stands up
  (`wake_up = false` in the configuration: it is refused for good); that walk is refused with the
  reason, the next one walks.
- on closing: the walk stops, camera, head stiffness and Autonomous Life are put back. The robot
  stays standing as it is: going to rest is a motion, and nobody asked for it.

What is to be put back is kept in the robot's own memory too, so that a daemon that was killed and
started anew puts back what was there before its first life.
"""
