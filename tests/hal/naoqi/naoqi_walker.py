"""A process that walks at a velocity and renews it until it is killed: the daemon, at its worst."""

from __future__ import annotations

import sys
import threading

from hal.backends import OpenOptions
from hal.naoqi.robot import open_robot
from hal.types import PlanarMotion


def main() -> None:
    options = OpenOptions(name="test", width=160, height=120, section={"url": sys.argv[1]})
    robot = open_robot(options)
    robot.camera.unseen(20.0)
    if sys.argv[2] == "walk":
        robot.walk.set_velocity(PlanarMotion(0.09, 0.0, 0.0), 0.4)
    print("under way", flush=True)
    while not threading.Event().wait(0.04):
        robot.walk.renew(0.4)


if __name__ == "__main__":
    main()
