"""`naod learn`: a colour model from marked pictures."""

from __future__ import annotations

import argparse
from pathlib import Path

from naod.cli.output import Progress, print_json
from naod.cli.pictures import find_files, read_pictures
from naod.errors import InputError
from naod.perception.colour_model import Region, save_model
from naod.perception.learning import DEFAULT_KIND, KINDS, learn_model


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """FRAME... --region X,Y,W,H --out MODEL.toml [--json]."""
    parser.add_argument("frames", nargs="+", metavar="FRAME", help="pictures, folders or videos")
    parser.add_argument(
        "--region",
        required=True,
        metavar="X,Y,W,H",
        help="part of each picture that shows only the object: left, top, width, height in pixels",
    )
    parser.add_argument("--out", required=True, type=Path, metavar="MODEL.toml")
    parser.add_argument(
        "--model-kind",
        choices=KINDS,
        default=DEFAULT_KIND,
        help="the paper's one Gaussian, a mixture of as many as the colours need, or a table "
        "that knows blur and surroundings (default: %(default)s)",
    )
    parser.add_argument("--json", action="store_true", help="one JSON document on stdout")


def parse_region(text: str) -> Region:
    """X,Y,W,H as four whole numbers. Raises InputError."""
    try:
        x, y, width, height = (int(part) for part in text.split(","))
    except ValueError:
        raise InputError(f"--region {text!r}: want X,Y,W,H as four whole numbers") from None
    return Region(x, y, width, height)


def run(args: argparse.Namespace) -> int:
    """Learn and write the model."""
    region = parse_region(args.region)
    progress = Progress("reading")
    frames = []
    for picture in read_pictures(find_files(args.frames)):
        if region.x + region.width > picture.width:
            size = f"{picture.width}x{picture.height}"
            raise InputError(f"{picture.source}: the region is outside the {size} picture")
        frames.append(picture.yuyv)
        progress.tick(picture.stem)
    progress.done()
    model = learn_model(frames, region, args.model_kind)
    save_model(args.out, model)
    if args.json:
        print_json(
            {
                "model": str(args.out),
                "kind": args.model_kind,
                "frames": len(frames),
                "pixels": len(frames) * region.width * region.height,
                "mean": model.mean,
                "covariance": model.covariance,
            }
        )
    else:
        y, u, v = model.mean
        print(f"{args.out}: Y {y:.0f}, U {u:.0f}, V {v:.0f} from {len(frames)} frames")
    return 0
