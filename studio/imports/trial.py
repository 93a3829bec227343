"""A written mechanism.py, loaded and built in memory before it is put into anyone's folder."""

from __future__ import annotations

from types import ModuleType

from mbsd import Mechanism, MechanismError
from shared.stage.errors import UserError
from studio.imports.names import printable


def try_out(text: str, name: str) -> Mechanism:
    """Return the mechanism that a mechanism.py builds. Raises UserError where it cannot be saved, loaded or built.

    A reason that is no MechanismError is a fault of the importer, and the message says so.
    """
    module = ModuleType(name)
    try:
        exec(compile(text.encode(), f"{name}/mechanism.py", "exec", dont_inherit=True), module.__dict__)
        return module.build(module.Params())
    except MechanismError as error:
        raise UserError(f"what was read makes no mechanism: {error}") from error
    except Exception as error:
        cause = f"{type(error).__name__}: {printable(str(error))[:200]}"
        raise UserError(
            f"what was read makes no file that can be loaded ({cause}); that is a fault of this importer: "
            "please report it"
        ) from error
