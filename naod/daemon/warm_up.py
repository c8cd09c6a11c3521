"""Compiling before it matters: the whole step runs once on a picture we paint ourselves.

The first run of the kernels on a machine takes longer than the watchdog waits.
"""

from __future__ import annotations

import logging

import numpy as np
from numpy.typing import NDArray

from hal.errors import HalError
from hal.protocols import Robot
from hal.types import BodyState, Frame
from naod.finding.find import finer
from naod.finding.hue import Colours
from naod.finding.regions import regions_of
from naod.geometry.camera import PinholeCamera
from naod.loop.equipment import Equipment, Sighting
from naod.perception.colour_model import Region
from naod.perception.learning import DEFAULT_KIND, KINDS, ModelKind, learn_model
from naod.pose.objects import Cylinder, ObjectShape
from naod.pose.prior import Prior

log = logging.getLogger(__name__)

_GREY, _RED = (120, 128, 128), (90, 100, 210)


FIRST_PICTURE_S = 5.0


def warm_up(equipment: Equipment, robot: Robot) -> None:
    """Take a picture, then learn and localise a painted object; nothing of it is kept.

    Raises HalError when the body does not answer; a camera that does not is the loop's affair.
    """
    writeable = False
    try:
        writeable = bool(robot.camera.unseen(FIRST_PICTURE_S).yuyv.flags.writeable)
    except HalError as error:
        log.warning("no first picture: %s", error)
    body = robot.body.latest()
    # the model in the state folder may be of any kind
    seen = [rehearse(equipment, body, writeable, kind) for kind in KINDS]
    if any(sighting is None or sighting.pose is None for sighting in seen):
        log.warning("the painted object was not localised: the first look may take longer")


def rehearse(
    equipment: Equipment,
    body: BodyState,
    writeable: bool = False,
    kind: ModelKind = DEFAULT_KIND,
) -> Sighting | None:
    """What is seen of an object painted in the middle of the picture, a quarter of its height.

    `writeable` is as in the camera's own pictures: kernels are compiled anew for the other kind.
    `kind`: of the model that is learnt.
    """
    camera, region = equipment.camera, _silhouette(equipment.shape, equipment.camera)
    yuyv = _painted(camera.width, camera.height, region)
    yuyv.flags.writeable = writeable
    frame = Frame(body.stamp_ns, yuyv, equipment.camera_name, 0.01, 0)
    model = learn_model([yuyv, yuyv], region, kind)
    sighting = equipment.sight(model, frame, body)
    if sighting is not None:
        # an easy picture needs none of these, the first real one may need all
        for _ in finer(regions_of(sighting.segmentation), Colours(yuyv, model)):
            pass
        if sighting.pose is not None:
            pose = sighting.pose
            equipment.sight(model, frame, body, Prior(pose.T_camera_object, pose.covariance, 0.1))
    return sighting


def _silhouette(shape: ObjectShape, camera: PinholeCamera) -> Region:
    """The object seen straight on; its width is on whole pairs of pixels."""
    wide = 2.0 * shape.radius_m if isinstance(shape, Cylinder) else shape.width_m
    height = camera.height // 4
    width = round(height * wide / shape.height_m * camera.fx / camera.fy / 2.0) * 2
    width = min(max(width, 8), camera.width // 2 // 2 * 2)
    return Region((camera.width - width) // 4 * 2, (camera.height - height) // 2, width, height)


def _painted(width: int, height: int, region: Region) -> NDArray[np.uint8]:
    """A red rectangle on grey, with a little noise; (height, width, 2) YUYV."""
    rng = np.random.default_rng(0)
    yuyv = np.empty((height, width, 2), dtype=np.uint8)
    columns = slice(region.x, region.x + region.width)
    rows = slice(region.y, region.y + region.height)
    for place, (y, u, v) in (((slice(None), slice(None)), _GREY), ((rows, columns), _RED)):
        yuyv[(*place, 0)] = y
        yuyv[(*place, 1)][:, 0::2] = u
        yuyv[(*place, 1)][:, 1::2] = v
    noise = rng.integers(-3, 4, size=yuyv.shape, dtype=np.int16)
    return (yuyv.astype(np.int16) + noise).astype(np.uint8)
