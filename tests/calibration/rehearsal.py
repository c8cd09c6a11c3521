"""A simulated robot before a rectangle, its camera askew; and a colour model of the rectangle."""

import math

from hal.backends import OpenOptions, open_robot
from hal.scenario import CameraSection, RobotSection, Scenario, SceneSection, ThingSection
from naod.config import CameraConfig, DaemonConfig
from naod.experiment.person import mark
from naod.geometry.camera import nominal_camera
from naod.perception.colour_model import Region, learn
from naod.pose.objects import shape_of

ERROR_DEG = (5.0, -5.0, 5.0)


def opened(error_deg=ERROR_DEG, camera="top", seed=1, ahead=0.85, noise_std=2.0):
    scenario = Scenario(
        robot=RobotSection(start=(1.6 - ahead, 0.05, 0.0)),
        object=ThingSection(kind="rectangle", position=(1.6, 0.0, 0.52), yaw_deg=160.0),
        scene=SceneSection(table=False),
        camera=CameraSection(mount_error_deg=error_deg, noise_std=noise_std),
    )
    options = OpenOptions(
        camera=camera, section={"scenario": scenario, "seed": seed, "real_time": False}
    )
    return open_robot("sim", options)


def settled(robot):
    x, y, yaw_deg = robot.scenario.robot.start
    robot.place(type(robot.truth().base)(x, y, math.radians(yaw_deg)))
    robot.advance(robot.clock.now_ns() + 2 * 10**9)


def learnt(robot):
    shape = shape_of(robot.scenario.object)
    region = mark(robot.truth(), shape, nominal_camera("v6", 640, 480))
    frame = robot.camera.next(2.0)
    return learn([frame.yuyv], Region(region.x, region.y, region.width, region.height)), shape


def config(**camera):
    return DaemonConfig(camera=CameraConfig(**camera))
