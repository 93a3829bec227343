"""Trial of a written mechanism.py: loaded and built in memory, and compared with its source.

It takes place before the file is saved.

So no file that cannot be loaded is ever in a user's folder, where it would be in the way of the next import.
"""

from __future__ import annotations

from types import ModuleType

from mbsd import Mechanism, MechanismError
from shared.stage.errors import UserError
from studio.imports.names import printable
from studio.imports.sketch import Sketch


def try_out(text: str, name: str) -> Mechanism:
    """Return the mechanism that a mechanism.py builds.

    Raises UserError if it cannot be saved, loaded or built.

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


def difference(sketch: Sketch, m: Mechanism) -> str:
    """Return how the degrees of freedom differ from those of the file; "" if they do not.

    Joints that repeat each other leave more than a count of joints tells, so that more is no difference.
    """
    try:
        freedom = m.mobility().dof
    except MechanismError:  # which the look at the model names
        return ""
    if sketch.freedom is not None and not freedom >= sketch.freedom == sketch.counted_freedom():
        return (
            f"the degrees of freedom differ: {sketch.freedom} in the file, {freedom} in this mechanism; "
            "it moves otherwise until what was left out is added"
        )
    if sketch.inputs and sketch.inputs != freedom:
        return (
            f"the inputs of the file ({sketch.inputs}) move all of it there, and this mechanism has {freedom} "
            "degrees of freedom: something was left out or misread, or is loose in the file"
        )
    return ""
