"""Exceptions. Each says what is wrong, where, and how to mend it."""

from __future__ import annotations

from typing import Any


class HangposeError(Exception):
    """Base of all exceptions of this module, with the fields of ``hangpose_detail`` in C.

    Attributes:
        field: Name of the wrong argument, such as ``"triangles"``, or ``""``.
        index: Index of the wrong vertex, triangle, point or image, or ``None``.
        value: The wrong value, or ``None`` if it is not a number or does not apply.
        minimum: Least valid value, or ``None``.
        maximum: Greatest valid value, or ``None``.
    """

    def __init__(
        self,
        message: str,
        *,
        field: str = "",
        index: int | None = None,
        value: float | None = None,
        minimum: float | None = None,
        maximum: float | None = None,
    ) -> None:
        super().__init__(message)
        self.field = field
        self.index = index
        self.value = value
        self.minimum = minimum
        self.maximum = maximum


class InvalidInput(HangposeError, ValueError):
    """An argument is wrong."""


class UnreadableFile(HangposeError, OSError):
    """A file cannot be read, or its content is not what its extension says."""

    def __str__(self) -> str:
        return str(self.args[0])


class Cancelled(HangposeError, RuntimeError):
    """The call was cancelled."""


class NoPath(HangposeError, RuntimeError):
    """There is no path to a pose, or none was found.

    Attributes:
        reason: ``"goal_in_collision"``, ``"budget_used_up"`` and so on, as in the JSON of the command.
        collision: What collides with what, as a dictionary, or ``None``.
    """

    def __init__(self, message: str, *, reason: str = "", collision: dict[str, Any] | None = None) -> None:
        super().__init__(message)
        self.reason = reason
        self.collision = collision
