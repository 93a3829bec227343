"""Build and measure as bytes that need no file of the user where they are read."""

from __future__ import annotations

import functools
import io
from collections.abc import Callable
from types import ModuleType
from typing import Any

from mbsd.base.errors import ModelError


def bytes_of(build: Any, measure: Any, modules: dict[str, ModuleType]) -> bytes:
    """Build and measure with what they use of ``modules``. Raises ModelError where that cannot be sent."""
    try:
        import cloudpickle
    except ImportError as error:
        raise ModelError("study needs cloudpickle: install mbsd[study]") from error
    by_value = [module for name, module in modules.items() if name != "__main__"]

    class Pickler(cloudpickle.CloudPickler):
        """Takes cached functions along, too, with an empty cache; by itself pickle names their module."""

        def reducer_override(self, obj: Any) -> Any:
            wrapped = getattr(obj, "__wrapped__", None)
            if type(obj) is functools._lru_cache_wrapper and getattr(wrapped, "__module__", None) in modules:  # pyright: ignore[reportAttributeAccessIssue]
                return _cached, (wrapped, obj.cache_parameters())
            return super().reducer_override(obj)

    for module in by_value:
        cloudpickle.register_pickle_by_value(module)
    try:
        content = io.BytesIO()
        Pickler(content).dump((build, measure))
        return content.getvalue()
    except Exception as error:
        raise ModelError(f"study: build or measure cannot be sent to another process: {error}") from error
    finally:
        for module in by_value:
            cloudpickle.unregister_pickle_by_value(module)


def _cached(function: Callable[..., Any], parameters: dict[str, Any]) -> Callable[..., Any]:
    return functools.lru_cache(**parameters)(function)
