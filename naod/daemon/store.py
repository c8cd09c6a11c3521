"""The state folder: goals, the colour model, the latched estop. Written whole or not at all."""

from __future__ import annotations

from pathlib import Path

from naod.approach.goal import Goal, load_goals, save_goal
from naod.errors import InputError
from naod.perception.colour_model import ColourModel, load_model, save_model
from naod.walk_server.latch import EstopLatch


class Store:
    """What outlives the process. Raises InputError when the folder cannot be made."""

    def __init__(self, folder: Path) -> None:
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise InputError(f"{folder}: cannot make the state folder: {error.strerror}") from None
        self.folder = folder
        self.latch = EstopLatch(folder)
        self._model_path = folder / "model.toml"

    def goals(self) -> dict[str, Goal]:
        """All goals that were taught. Raises InputError for a damaged file."""
        return load_goals(self.folder)

    def model(self) -> ColourModel | None:
        """The colour that was learnt last. Raises InputError for a damaged file."""
        return load_model(self._model_path) if self._model_path.exists() else None

    def keep_goal(self, name: str, goal: Goal) -> None:
        """Keep a goal. Raises InputError."""
        save_goal(self.folder, name, goal)

    def keep_model(self, model: ColourModel) -> None:
        """Keep the colour model. Raises InputError."""
        save_model(self._model_path, model)
