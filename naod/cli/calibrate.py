"""`naod calibrate`: this head's camera, from a rectangle of known size."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import cv2
import msgspec
import numpy as np
from numpy.typing import NDArray

from hal.protocols import Robot
from hal.yuyv import rgb_from_yuyv
from naod.calibration.editing import write_camera
from naod.calibration.procedure import VIEWS, Wanted, await_obedience, calibrate
from naod.calibration.result import VIEWS_MIN, Calibration, CalibrationError, camera_lines
from naod.calibration.warm_up import warm_up
from naod.cli.learn import parse_region
from naod.cli.output import print_json
from naod.config import DaemonConfig, load_config, state_folder
from naod.daemon.opening import open_configured, shape_for
from naod.errors import InputError
from naod.files import write_whole
from naod.perception.colour_model import ColourModel, learn, load_model
from naod.pose.objects import ObjectShape, Rectangle, load_object

PICTURE_S = 5.0
VIEWS_MAX = 100

EPILOG = """\
Fix a rectangle in one plain colour, of a size you have measured, upright about 0.8 m before the
standing robot, so that a quarter of the picture's width shows it. No daemon must be running.

  naod calibrate --config naod.toml --picture view.jpg       see where it is
  naod calibrate --config naod.toml --region 250,180,90,60   mark its inside; the head turns
  ... --write                                                put the result into the file
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command line of `naod calibrate`."""
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.epilog = EPILOG
    parser.add_argument("--config", type=Path, metavar="FILE", help="default: a simulated robot")
    parser.add_argument(
        "--object", type=Path, metavar="OBJECT.toml", help="the rectangle; default: [object]"
    )
    colour = parser.add_mutually_exclusive_group()
    colour.add_argument("--model", type=Path, metavar="MODEL.toml", help="its colour")
    colour.add_argument("--region", metavar="X,Y,W,H", help="where its colour is in the picture")
    parser.add_argument("--picture", type=Path, metavar="FILE", help="save what is seen, and end")
    parser.add_argument(
        "--views", type=int, default=VIEWS, metavar="N", help=f"head poses; default: {VIEWS}"
    )
    parser.add_argument("--by-hand", action="store_true", help="you turn the head, slowly")
    parser.add_argument(
        "--keep-intrinsics", action="store_true", help="only the three angles, not the lens"
    )
    parser.add_argument("--write", action="store_true", help="put the result into the file")
    parser.add_argument("--json", action="store_true", help="one JSON document on stdout")


def run(args: argparse.Namespace) -> int:
    """Exit status 1 when the views do not tell how the camera sits. Raises InputError, HalError."""
    if not VIEWS_MIN <= args.views <= VIEWS_MAX:
        raise InputError(f"--views {args.views}: want {VIEWS_MIN} to {VIEWS_MAX}")
    if args.write and args.config is None:
        raise InputError("--write: needs a --config to write to")
    config = load_config(args.config)
    shape = None if args.object is None else _rectangle(load_object(args.object))
    model = None if args.model is None else load_model(args.model)
    region = None if args.region is None else parse_region(args.region)
    if model is None and region is None and args.picture is None:
        model = _known(config)
    beside = Path.cwd() if args.config is None else args.config.resolve().parent
    if args.picture is None:
        warm_up(config)
    robot = open_configured(config, beside, real_time=False)
    try:
        if not args.by_hand:
            await_obedience(robot, _tell)
        frame = robot.camera.next(PICTURE_S)
        if args.picture is not None:
            return _save(args.picture, frame.yuyv)
        shape = shape or _rectangle(shape_for(config, robot))
        if region is not None:
            model = learn([frame.yuyv], region)
        assert model is not None
        return _calibrated(args, config, robot, model, shape)
    finally:
        robot.close()


def _calibrated(
    args: argparse.Namespace,
    config: DaemonConfig,
    robot: Robot,
    model: ColourModel,
    shape: Rectangle,
) -> int:
    wanted = Wanted(args.views, args.by_hand, not args.keep_intrinsics)
    try:
        found = calibrate(robot, config, model, shape, wanted, _tell)
    except CalibrationError as error:
        print(f"naod calibrate: {error}", file=sys.stderr)
        return 1
    lines = camera_lines(found)
    if args.write:
        write_camera(args.config, lines)
    if args.json:
        document = msgspec.to_builtins(found)
        print_json({**document, "written": str(args.config) if args.write else None})
    else:
        _report(found, lines)
        if args.write:
            print(f"written to {args.config}")
    return 0


def _report(found: Calibration, lines: dict[str, str]) -> None:
    x, y, z = (row[3] for row in found.T_base_object[:3])
    left_out = f", {found.views_left_out} left out" if found.views_left_out else ""
    roll, pitch, yaw = found.sigma_deg
    print(
        f"# {found.views} views{left_out}; {found.rms_px:.2f} px are left over\n"
        f"# correction sure to {roll:.2f}, {pitch:.2f}, {yaw:.2f} degrees (one sigma)"
    )
    if found.lens_fitted:
        fx, fy, cx, cy, k1 = found.lens_sigma
        print(f"# fx, fy, cx, cy sure to {fx:.1f}, {fy:.1f}, {cx:.1f}, {cy:.1f} px, k1 to {k1:.4f}")
    side = "left" if y > 0.0 else "right"
    print(f"# the rectangle was {x:.2f} m ahead, {abs(y):.2f} m to the {side}, {z:.2f} m up")
    print("[camera]")
    for key, value in lines.items():
        print(f"{key} = {value}")


def _rectangle(shape: ObjectShape) -> Rectangle:
    if not isinstance(shape, Rectangle):
        raise InputError(
            "the object is a cylinder: calibration needs a rectangle, by --object or as [object] "
            'kind = "rectangle" with width_m and height_m'
        )
    return shape


def _known(config: DaemonConfig) -> ColourModel:
    path = state_folder(config) / "model.toml"
    if not path.exists():
        raise InputError("the rectangle's colour is not known: give --region or --model")
    return load_model(path)


def _save(path: Path, yuyv: NDArray[np.uint8]) -> int:
    try:
        done, data = cv2.imencode(path.suffix or ".jpg", rgb_from_yuyv(yuyv)[..., ::-1])
    except cv2.error:
        done = False
    if not done:
        raise InputError(f"--picture {path}: want a name that ends in .jpg or .png")
    write_whole(path, data.tobytes())
    return 0


def _tell(text: str) -> None:
    print(f"naod calibrate: {text}", file=sys.stderr, flush=True)
