"""One object of a document, read field by field; every refusal names the file and the field."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any, TypeVar

from mbsd.base.arguments import finite_number
from mbsd.base.errors import ModelError
from mbsd.base.names import no_such, shown

T = TypeVar("T")


class Entry:
    """An object of a JSON document and where it stands: ``my.json: joints.A``."""

    def __init__(self, data: Any, where: str) -> None:
        if not isinstance(data, Mapping):
            raise ModelError(f"{where} is {shown(data)}; it must be an object")
        self.data = data
        self.where = where

    def get(self, key: str) -> Any:
        """The value as it is, None if there is none."""
        return self.data.get(key)

    def number(self, key: str) -> float:
        """A finite number."""
        return _number(self._needed(key), f"{self.where}.{key}")

    def number_or_none(self, key: str) -> float | None:
        """A finite number, or null."""
        value = self._needed(key)
        return None if value is None else _number(value, f"{self.where}.{key}")

    def is_null(self, key: str) -> bool:
        """Return True if a field that must be there is null."""
        return self._needed(key) is None

    def numbers(self, key: str, count: int) -> tuple[Any, ...]:
        """A list of ``count`` finite numbers."""
        values = self._needed(key)
        if not isinstance(values, list) or len(values) != count:
            raise ModelError(f"{self.where}.{key} is {shown(values)}; it must be a list of {count} numbers")
        return tuple(_number(value, f"{self.where}.{key}[{k}]") for k, value in enumerate(values))

    def text(self, key: str) -> str:
        """A string."""
        value = self._needed(key)
        if not isinstance(value, str):
            raise ModelError(f"{self.where}.{key} is {shown(value)}; it must be a text")
        return value

    def entry(self, key: str) -> Entry:
        """An object within."""
        return Entry(self._needed(key), f"{self.where}.{key}")

    def entries(self, key: str) -> Iterator[tuple[str, Entry]]:
        """The named objects of a table such as ``bodies``."""
        table = self.entry(key)
        for name in table.data:
            yield name, table.entry(name)

    def within(self, read: Callable[[], T]) -> T:
        """Return what ``read`` returns; its ModelError gets the position in the file."""
        try:
            return read()
        except ModelError as error:
            raise ModelError(f"{self.where}: {error}") from error

    def refuse_others(self, *known: str) -> None:
        """Raise ModelError for a field that is not one of ``known``."""
        others = [key for key in self.data if key not in known]
        if others:
            raise ModelError(f"{self.where}: {no_such('field', others[0], known)}")

    def _needed(self, key: str) -> Any:
        if key not in self.data:
            raise ModelError(f"{self.where}: the field '{key}' is missing")
        return self.data[key]


def _number(value: Any, where: str) -> float:
    return finite_number(where, value)
