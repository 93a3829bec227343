"""The mechanism in a file of another program, which is recognised by its content.

All files come in by one way: :func:`read` gets a limited number of bytes, asks which format they are, and turns what a
damaged file brings about in its importer into a UserError. Importers raise UserError themselves where they know more.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import numpy as np

from mbsd import Mechanism, MechanismError
from shared.stage.errors import UserError
from studio.imports import asmt, dxf, linkage, mbsd_core, pmks_text, pmks_url, pylinkage
from studio.imports.limits import printable, read_bytes
from studio.imports.sketch import Sketch

FORMATS: dict[str, tuple[Callable[[str], bool], Callable[[str, str], Sketch]]] = {
    "PMKS+ (its address)": (pmks_url.is_pmks_url, pmks_url.read),
    "Linkage (.linkage2)": (linkage.is_linkage, linkage.read),
    "Ondsel and FreeCAD (.asmt)": (asmt.is_asmt, asmt.read),
    "a sketch (DXF)": (dxf.is_dxf, dxf.read),
    "PMKS (.txt, .pmks)": (pmks_text.is_pmks, pmks_text.read),
    "mbsd-core (JSON)": (mbsd_core.is_mbsd_core, mbsd_core.read),
    "pylinkage (JSON)": (pylinkage.is_pylinkage, pylinkage.read),
}
DAMAGE = (ValueError, LookupError, TypeError, AttributeError, ArithmeticError, RecursionError)
"""Errors that importers meet in a file that lacks something, or has something else in its place."""
ENCODINGS = ("utf-8-sig", "cp1252", "latin-1")


def read(source: str) -> Sketch:
    """Return the mechanism of a file, or of an address of PMKS+.

    Raises UserError for what is neither, for a file that cannot be read, and for one that is damaged or too large.
    """
    if "://" in source or pmks_url.is_pmks_url(source):
        return read_text(source, "address")
    file = Path(source)
    return read_text(_decoded(read_bytes(file), file), file.name)


def read_text(text: str, name: str) -> Sketch:
    """Return the mechanism of the content of a file, called ``name`` in messages.

    Raises UserError as :func:`read` does.
    """
    name = printable(name)
    for program, (is_one, reader) in FORMATS.items():
        if not is_one(text):
            continue
        try:
            with np.errstate(over="raise", divide="raise", invalid="raise"):
                sketch = reader(text, name)
                sketch.check()
        except UserError as error:
            raise UserError(f"{name}: {printable(str(error))}") from error
        except DAMAGE as error:
            cause = printable(str(error))[:200]
            raise UserError(
                f"{name}: it is damaged, or no file of {program} ({type(error).__name__}: {cause})"
            ) from error
        sketch.left_out = [printable(words) for words in sketch.left_out]
        return sketch
    raise UserError(f"{name} is not a file of a known program; known are: {', '.join(FORMATS)}")


def _decoded(content: bytes, file: Path) -> str:
    if b"\0" in content:
        raise UserError(f"{printable(str(file))} is not text")
    for encoding in ENCODINGS:
        try:
            return content.decode(encoding)
        except UnicodeDecodeError:
            continue
    raise UserError(f"{printable(str(file))} is not text")


# Trial of a written mechanism.py: loaded and built in memory, and compared with its source.
#
# It takes place before the file is saved.
#
# So no file that cannot be loaded is ever in a user's folder, where it would be in the way of the next import.


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
        raise UserError(f"the file makes no valid mechanism: {error}") from error
    except Exception as error:
        cause = f"{type(error).__name__}: {printable(str(error))[:200]}"
        raise UserError(
            f"the written mechanism.py cannot be loaded ({cause}); that is a fault of this importer: please report it"
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
            "it moves differently until you add what was left out"
        )
    if sketch.inputs and sketch.inputs != freedom:
        return (
            f"the inputs of the file ({sketch.inputs}) move all of it there, but this mechanism has {freedom} "
            "degrees of freedom. Something was left out or misread, or is loose in the file"
        )
    return ""
