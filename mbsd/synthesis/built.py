"""Functions of the author that build mechanisms of numbers: checks before and after a call."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from mbsd.base.arguments import described, named_parameters
from mbsd.base.errors import MechanismError, ModelError
from mbsd.base.names import shown
from mbsd.model.mechanism import Model


def refuse_build(what: str, build: Any, names: Sequence[str]) -> None:
    """Raise ModelError for what is no function of arguments ``names``, as far as its signature says."""
    if not callable(build):
        raise ModelError(f"{what}: build is {shown(build)}; give a function that returns the mechanism")
    parameters = named_parameters(build)
    if parameters is None:
        return
    for name in names:
        if name not in parameters or parameters[name].kind is inspect.Parameter.POSITIONAL_ONLY:
            raise ModelError(f"{what}: build has no argument '{name}'; it has {', '.join(parameters) or 'none'}")
    for name, p in parameters.items():
        if name not in names and p.default is p.empty and p.kind is not p.VAR_POSITIONAL:
            raise ModelError(f"{what}: argument '{name}' of build neither varies nor has a default; give it one")


def built(what: str, build: Callable[..., Any], values: Mapping[str, Any]) -> Model:
    """Return what ``build`` returns. Raises ModelError for anything but a Mechanism, and for errors not of mbsd."""
    try:
        made = build(**values)
    except MechanismError:
        raise
    except Exception as error:
        raise ModelError(f"{what}: build fails: {described(error)}") from error
    if not isinstance(made, Model):
        raise ModelError(f"{what}: build returned {type(made).__name__}, not a Mechanism")
    return made
