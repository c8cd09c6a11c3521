"""JSON Schema files, one per message: `python -m naod.bus.schema deploy/schema`."""

from __future__ import annotations

import inspect
import sys
from pathlib import Path

import msgspec

from naod import messages
from naod.bus import keys
from naod.files import write_whole
from naod.messages import Message

PUBLISHED: dict[str, type[Message]] = {
    keys.WALK_COMMAND: messages.WalkCommand,
    keys.WALK_STATE: messages.WalkState,
    keys.HEAD_COMMAND: messages.HeadCommand,
    keys.STATE: messages.StateMessage,
    keys.EVENT: messages.EventMessage,
    keys.DIAGNOSTICS: messages.DiagnosticsMessage,
    keys.TRUTH: messages.TruthMessage,
}

CALLED: dict[str, type[Message]] = {
    "status": messages.NoArguments,
    "watch": messages.NoArguments,
    "start": messages.GoalCall,
    "stop": messages.NoArguments,
    "estop": messages.NoArguments,
    "release": messages.NoArguments,
    "label": messages.LabelCall,
    "teach": messages.GoalCall,
    "goals": messages.NoArguments,
    "picture": messages.NoArguments,
    "walk": messages.WalkCommand,
    "head": messages.HeadCommand,
}

ANSWERED: dict[str, type[Message]] = {
    "status": messages.StatusReply,
    "picture": messages.PictureReply,
    "failure": messages.FailureReply,
}


def schema_files() -> dict[str, str]:
    """Name and text of every schema file."""
    named: dict[str, type[Message]] = {}
    named |= {name.replace("/", "_"): kind for name, kind in PUBLISHED.items()}
    named |= {f"rpc_{verb}": kind for verb, kind in CALLED.items()}
    named |= {f"rpc_{name}_reply": kind for name, kind in ANSWERED.items()}
    return {f"{name}.json": _text(kind) for name, kind in sorted(named.items())}


def main(folder: Path) -> None:
    """Write them all; files of messages that are gone are removed."""
    wanted = schema_files()
    for name, text in wanted.items():
        write_whole(folder / name, text)
    for path in folder.glob("*.json"):
        if path.name not in wanted:
            path.unlink()


def _text(kind: type[Message]) -> str:
    schema = msgspec.json.schema(kind)
    for definition in schema["$defs"].values():
        if "description" in definition:
            definition["description"] = inspect.cleandoc(definition["description"])
    document = {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema}
    return msgspec.json.format(msgspec.json.encode(document), indent=2).decode() + "\n"


if __name__ == "__main__":
    main(Path(sys.argv[1]))
