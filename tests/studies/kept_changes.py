# ruff: noqa: E501
"""Changes of what a study uses: a script with what it imports or reads, an edit of one file, and whether it matters."""

from __future__ import annotations

from typing import NamedTuple

BUILD = "def build(x):\n    return x\n"


class Change(NamedTuple):
    """The files of a study, and an edit of one of them; a file without old text appears."""

    files: dict[str, str]
    edited: str
    old: str
    new: str


def script(head: str, value: str, old: str = "2.0", new: str = "3.0") -> Change:
    """A script alone; ``value`` is what measure multiplies a point with."""
    return Change(
        {"script.py": f"{head}\n{BUILD}\ndef measure(m):\n    return {{'y': m * ({value})}}\n"}, "script.py", old, new
    )


def using(head: str, value: str, old: str = "2.0", new: str = "3.0", **others: str) -> Change:
    """A script with other files, of which the last is edited: ``pkg=`` is pkg/__init__.py, ``pkg_sub=`` pkg/sub.py."""
    files = {"pkg/__init__.py" if n == "pkg" else f"{n.replace('_', '/')}.py": text for n, text in others.items()}
    return Change(script(head, value).files | files, [*files][-1], old, new)


def reading(head: str, value: str, name: str = "data.txt", old: str = "2.0", new: str = "3.0") -> Change:
    """A script that reads a file."""
    files = script("from pathlib import Path\nHERE = Path(__file__).parent\n" + head, value).files
    return Change(files | ({name: old} if old else {}), name, old, new)


F = "def f():\n    return 2.0\n"
K = "K = 2.0\n"
LAW = "class Law:\n    def __init__(self, f):\n        self.f = f\n"
DATA = "HERE.joinpath('data.txt')"
LOADER = "import functools\n@functools.cache\ndef factor():\n    return float((HERE / 'data.txt').read_text())\n"
SPEC = (
    "import importlib.util\ndef load():\n"
    "    spec = importlib.util.spec_from_file_location('other', HERE / 'other.py')\n"
    "    module = importlib.util.module_from_spec(spec)\n    spec.loader.exec_module(module)\n    return module.K\n"
)

CHANGES: dict[str, Change] = {
    "a constant": script(K, "K"),
    "code of measure": script("", "2.0"),
    "code of build": Change({"script.py": "def build(x):\n    return 2.0 * x\ndef measure(m):\n    return {'y': m}\n"},
                            "script.py", "2.0", "3.0"),
    "a helper": script(F, "f()"),
    "a helper of a helper": script("def g():\n    return 2.0\ndef f():\n    return g()\n", "f()"),
    "a helper in a module": using("from helper import f", "f()", helper=F),
    "a helper of a helper in a module": using("from helper import f", "f()", helper="from deep import g\ndef f():\n    return g()\n",
                                              deep="def g():\n    return 2.0\n"),
    "a module": using("import helper", "helper.f()", helper=F),
    "a constant of a module": using("import helper", "helper.K", helper=K),
    "a module of a module": using("import helper", "helper.f()", helper="import deep\ndef f():\n    return deep.K\n", deep=K),
    "a module below a package": using("import pkg.sub", "pkg.sub.f()", pkg="", pkg_sub=F),
    "a package that imports what is below": using("import pkg", "pkg.sub.f()", pkg="from . import sub\n", pkg_sub=F),
    "a relative import": using("import pkg", "pkg.f()", pkg="from .sub import f\n", pkg_sub=F),
    "an attribute of a module by its name": using("import helper", "getattr(helper, 'f')()", helper=F),
    "an attribute of a module that the script sets": script("import math\nimport types\nhelper = types.SimpleNamespace()\n"
                                                             "helper.K = 2.0\n", "helper.K"),
    "an import inside a function": using("def f():\n    import helper\n    return helper.K\n", "f()", helper=K),
    "a from-import inside a function": using("def f():\n    from helper import K\n    return K\n", "f()", helper=K),
    "a module imported by one imported inside": using("def f():\n    import helper\n    return helper.K\n", "f()",
                                                      helper="from deep import K\n", deep=K),
    "a package imported inside": using("def f():\n    from pkg import sub\n    return sub.K\n", "f()",
                                       pkg="", pkg_sub=K),
    "import_module": using("import importlib\n", "importlib.import_module('helper').K", helper=K),
    "__import__": using("", "__import__('helper').K", helper=K),
    "sys.modules": using("import sys\nimport helper as _\n", "sys.modules['helper'].K", helper=K),
    "a module by its path": Change(reading(SPEC, "load()").files | {"other.py": K}, "other.py", "2.0", "3.0"),
    "functools.cache": script("import functools\n@functools.cache\n" + F, "f()"),
    "functools.lru_cache in a module": using("from helper import f", "f()",
                                             helper="import functools\n@functools.lru_cache(maxsize=4)\n" + F),
    "a helper of a cached function": script("import functools\ndef g():\n    return 2.0\n@functools.cache\n"
                                            "def f():\n    return g()\n", "f()"),
    "np.vectorize": script("import numpy as np\ndef g(t):\n    return 2.0 * t\nf = np.vectorize(g)\n", "float(f(1.0))"),
    "a function held by an object": script(LAW + "LAW = Law(lambda: 2.0)\n", "LAW.f()"),
    "a helper of a function held by an object": script(LAW + F + "LAW = Law(lambda: f())\n", "LAW.f()"),
    "functions in a dict": script(F + "LAWS = {'a': f}\n", "LAWS['a']()"),
    "functions in a list in a tuple": script(F + "LAWS = ([f],)\n", "LAWS[0][0]()"),
    "a number held by an object": script(LAW + "LAW = Law(2.0)\n", "LAW.f"),
    "a method": script("class Law:\n    def at(self):\n        return 2.0\nLAW = Law()\n", "LAW.at()"),
    "a base class": script("class Base:\n    def at(self):\n        return 2.0\nclass Law(Base):\n    pass\n", "Law().at()"),
    "a base class in a module": using("from helper import Base\nclass Law(Base):\n    pass\n", "Law().K",
                                      helper="class Base:\n    K = 2.0\n"),
    "a metaclass": script("class Meta(type):\n    @property\n    def K(cls):\n        return 2.0\n"
                          "class Law(metaclass=Meta):\n    pass\n", "Law.K"),
    "cached_property": script("from functools import cached_property\nclass Law:\n    @cached_property\n"
                              "    def K(self):\n        return 2.0\n", "Law().K"),
    "a property": script("class Law:\n    @property\n    def K(self):\n        return 2.0\n", "Law().K"),
    "a classmethod": script("class Law:\n    @classmethod\n    def at(cls):\n        return 2.0\n", "Law.at()"),
    "a staticmethod": script("class Law:\n    @staticmethod\n    def at():\n        return 2.0\n", "Law.at()"),
    "a nested class": script("class Law:\n    class Inner:\n        K = 2.0\n", "Law.Inner.K"),
    "a class inside a function": script("def f():\n    class Law:\n        K = 2.0\n    return Law.K\n", "f()"),
    "a class attribute": script("class Law:\n    K = 2.0\n", "Law.K"),
    "an array of a class": script("import numpy as np\nclass Law:\n    K = np.array([2.0])\n", "Law.K[0]"),
    "a descriptor": script("class Get:\n    def __get__(self, one, kind):\n        return 2.0\nclass Law:\n    K = Get()\n", "Law().K"),
    "slots": script("class Law:\n    __slots__ = ('K',)\n    def __init__(self):\n        self.K = 2.0\nLAW = Law()\n", "LAW.K"),
    "a default of a dataclass": script("from dataclasses import dataclass\n@dataclass(frozen=True)\nclass Params:\n    K: float = 2.0\n", "Params().K"),
    "a method of a dataclass": script("from dataclasses import dataclass\n@dataclass\nclass Params:\n    K: float = 1.0\n"
                                      "    def at(self):\n        return 2.0 * self.K\n", "Params().at()"),
    "a factory of a dataclass": script("from dataclasses import dataclass, field\n@dataclass\nclass Params:\n"
                                       "    K: list = field(default_factory=lambda: [2.0])\n", "Params().K[0]"),
    "an instance of a dataclass": script("from dataclasses import dataclass\n@dataclass(frozen=True)\nclass Params:\n    K: float\nP = Params(2.0)\n", "P.K"),
    "an enum": script("from enum import Enum\nclass Kind(Enum):\n    A = 2.0\n", "Kind.A.value"),
    "a named tuple": script("from typing import NamedTuple\nclass Params(NamedTuple):\n    K: float = 2.0\n", "Params().K"),
    "a default argument": script("def f(k=2.0):\n    return k\n", "f()"),
    "a default by keyword": script("def f(*, k=2.0):\n    return k\n", "f()"),
    "a closed-over value": script("def made(k):\n    return lambda: k\nf = made(2.0)\n", "f()"),
    "a partial": script("from functools import partial\nf = partial(max, 2.0)\n", "f(1.0)"),
    "a decorator that wraps a function of Python": script(
        "import functools, math\n@functools.wraps(math.sqrt)\ndef f():\n    return 2.0\n", "f()"),
    "a lambda": script("f = lambda: 2.0\n", "f()"),
    "a comprehension": script("", "sum([2.0 for _ in range(1)])"),
    "a generator": script("def f():\n    yield 2.0\n", "sum(f())"),
    "an attribute of a function": script("def f():\n    return f.k\nf.k = 2.0\n", "f()"),
    "an implementation of singledispatch": script(
        "import functools\n@functools.singledispatch\ndef f(x):\n    return 1.0\n@f.register\ndef _(x: int):\n    return 2.0\n", "f(1)"),
    "subclasses that register themselves": script("class Base:\n    K = 1.0\n", "[c.K for c in Base.__subclasses__()][0]")._replace(
        files={"script.py": "import helper\nfrom base import Base\n" + BUILD +
               "def measure(m):\n    return {'y': m * [c.K for c in Base.__subclasses__()][-1]}\n",
               "base.py": "class Base:\n    pass\n", "helper.py": "from base import Base\nclass Law(Base):\n    K = 2.0\n"},
        edited="helper.py"),
    "an array": script("import numpy as np\nA = np.array([1.0, 2.0])\n", "A[1]"),
    "a set": script("A = {1.0, 2.0}\n", "max(A)"),
    "which statements are tried": script("def f():\n    try:\n        g()\n    except NameError:\n        return 2.0\n", "f()"),
    "globals by a text": script(K, "globals()['K']"),
    "eval": script(K, "eval('K')"),
    "exec of a file": reading("def f():\n    names = {}\n    exec((HERE / 'data.txt').read_text(), names)\n    return names['K']\n",
                              "f()", old="K = 2.0", new="K = 3.0"),
    "run_path": reading("import runpy\n", "runpy.run_path(str(HERE / 'data.txt'))['K']", old="K = 2.0", new="K = 3.0"),
    "open": reading("def f():\n    with open(HERE / 'data.txt') as file:\n        return float(file.read())\n", "f()"),
    "read_text": reading("", f"float({DATA}.read_text())"),
    "a file read by a cached function": reading(LOADER, "factor()"),
    "a file read at import": reading(f"K = float({DATA}.read_text())\n", "K"),
    "np.loadtxt": reading("import numpy as np\n", f"float(np.loadtxt({DATA}))"),
    "pandas.read_csv": reading("import pandas\n", f"float(pandas.read_csv({DATA})['a'][0])", old="a\n2.0\n", new="a\n3.0\n"),
    "json": reading("import json\n", f"json.loads({DATA}.read_bytes())['a']", old='{"a": 2.0}', new='{"a": 3.0}'),
    "a file that appears": reading("", "3.0 if (HERE / 'data.txt').exists() else 2.0", old="", new="3.0"),
    "a file in a folder": reading("", "len(list(HERE.glob('*.txt'))) + 1", old="", new="3.0"),
    "a file read by a program": reading("import subprocess\n", f"float(subprocess.check_output(['cat', str({DATA})]))"),
    "a docstring that is read": script("def f():\n    '2.0'\n", "float(f.__doc__)"),
}  # fmt: skip
"""Points that have to be computed again."""

_CODE = (
    "K = 2.0\n"
    + F
    + "class Law:\n    '''A law.'''\n    def at(self):\n        '''Its value.'''\n        return K * f()\n"
)
_SCRIPT = script(_CODE, "Law().at()").files
_MODULE = using("import helper", "helper.f()", helper=F + "def unused():\n    return 1.0\n").files

SAME: dict[str, Change] = {
    "a comment": Change(_SCRIPT, "script.py", "K = 2.0", "# a factor\nK = 2.0  # newton"),
    "blank lines": Change(_SCRIPT, "script.py", "class Law", "\n\n\nclass Law"),
    "a docstring": Change(_SCRIPT, "script.py", "A law.", "The law."),
    "a docstring of a method": Change(_SCRIPT, "script.py", "Its value.", "The value."),
    "another order of definitions": Change(_SCRIPT, "script.py", "K = 2.0\n" + F, F + "K = 2.0\n"),
    "code that is not used": Change(_SCRIPT, "script.py", "K = 2.0", "def unused():\n    return 3.0\nK = 2.0"),
    "a grid in the script": Change(_SCRIPT, "script.py", "K = 2.0", "grid = {'x': [1.0, 2.0, 3.0]}\nK = 2.0"),
    "a comment in a module": Change(_MODULE, "helper.py", "def f", "# a helper\ndef f"),
    "a docstring in a module": Change(_MODULE, "helper.py", "def f():\n", "def f():\n    'A helper.'\n"),
    "a module that is not used": Change(_MODULE | {"other.py": K}, "other.py", "2.0", "3.0"),
    "the order of a dict": script("D = {'a': 2.0, 'b': 1.0}\n", "D['a']", "'a': 2.0, 'b': 1.0", "'b': 1.0, 'a': 2.0"),
    "the order of a set": script("D = {'a', 'b'}\n", "len(D)", "'a', 'b'", "'b', 'a'"),
    "a file that is not read": Change(reading("", f"float({DATA}.read_text())").files | {"notes.md": "old"}, "notes.md", "old", "new"),
    "a file in another folder": Change(reading("", "len(list(HERE.glob('*.txt')))").files | {"a/b.txt": "old"}, "a/b.txt", "old", "new"),
}  # fmt: skip
"""Changes of no number."""
