"""Pipeline by which numba reads kernels: stable names in all processes, inlined functions read once.

numba numbers the functions that it compiles, and the number is part of a function's name in machine code. Kernels that
call one another by name need a number that depends on the function alone, because the caller's code is kept and read by
another process.

A function that is copied into its callers passes the untyped part of the pipeline once, not once for each call: numba
copies the result anyway. Names of several kernels become one of them before calls are read (alternatives.py).
"""

from __future__ import annotations

import copy
import hashlib
from collections.abc import Callable
from typing import Any, Literal

from numba.core import bytecode, compiler, ir, ir_utils
from numba.core.analysis import compute_cfg_from_blocks
from numba.core.compiler_machinery import register_pass
from numba.core.inline_closurecall import (
    InlineWorker,
    _add_definitions,
    _created_inlined_var_name,
    _get_callee_args,
    _replace_args_with,
    _replace_returns,
)
from numba.core.ir_utils import add_offset_to_labels, find_topo_order, guard, next_label, replace_vars, simplify_CFG
from numba.core.postproc import PostProcessor
from numba.core.untyped_passes import ExtractByteCode, InlineInlinables

from mbsd.compiling.alternatives import choose

_READ: dict[Any, Any] = {}
"""Untyped code of the functions that are copied into others."""


class _Worker(InlineWorker):
    """Reads each function once."""

    def __init__(self, *arguments: Any) -> None:
        super().__init__(*arguments)
        self._compiler_pipeline = _untyped
        self.first: Any = None
        """numba's type of the first argument of the kernel that is compiled; None where there is none yet."""

    def inline_ir(self, caller_ir: Any, block: Any, i: int, callee_ir: Any, *_: Any, **__: Any) -> Any:
        """Put a copy of ``callee_ir`` in place of call ``i`` of a block, by numba's own steps.

        numba makes two copies, each of which takes all variables of the function along with every block.
        """
        copied: dict[int, Any] = {}
        blocks = {label: copy.deepcopy(callee_block, copied) for label, callee_block in callee_ir.blocks.items()}
        scope, statement = block.scope, block.body[i]
        choose(blocks.values(), self.first)
        blocks = add_offset_to_labels(blocks, max(ir_utils._the_max_label.next(), *caller_ir.blocks) + 1)
        blocks = simplify_CFG(blocks)
        first = min(blocks)
        ir_utils._the_max_label.update(max(blocks))
        (own,) = {id(callee_block.scope): callee_block.scope for callee_block in blocks.values()}.values()
        renamed = {}
        for variable in tuple(own.localvars._con.values()):
            name = _created_inlined_var_name(callee_ir.func_id.unique_name, variable.name)
            renamed[variable.name] = scope.redefine(name, loc=variable.loc)
        replace_vars(blocks, renamed)
        call = statement.value
        _replace_args_with(blocks, _get_callee_args(call, callee_ir.func_id.func, statement.loc, caller_ir))
        rest = ir.Block(scope, block.loc)
        rest.body = block.body[i + 1 :]
        after = next_label()
        caller_ir.blocks[after] = rest
        block.body = [*block.body[:i], ir.Jump(first, statement.loc)]
        order = find_topo_order(blocks)
        _replace_returns(blocks, statement.target, after)
        definitions = caller_ir._definitions
        if call in definitions.get(statement.target.name, ()):
            definitions[statement.target.name].remove(call)
        new = [(after, rest)]
        for label in order:
            blocks[label].scope = scope
            _add_definitions(caller_ir, blocks[label])
            caller_ir.blocks[label] = blocks[label]
            new.append((label, blocks[label]))
        return callee_ir, blocks, renamed, new

    def run_untyped_passes(self, func: Callable[..., Any], enable_ssa: bool = False) -> Any:
        """Return the code of ``func``, which callers copy."""
        if func not in _READ:
            flags = self.flags
            self.flags = flags.copy()  # numba switches SSA off in them
            try:
                _READ[func] = super().run_untyped_passes(func, enable_ssa)
            finally:
                self.flags = flags
        return _READ[func]


@register_pass(mutates_CFG=True, analysis_only=False)
class _Inline(InlineInlinables):
    """numba's pass, with our worker."""

    _name = "mbsd_inline_inlinables"

    def run_pass(self, state: Any) -> Literal[True]:
        """Run the pass as numba does."""
        worker = _Worker(state.typingctx, state.targetctx, state.locals, state.pipeline, state.flags, None)
        blocks, modified = state.func_ir.blocks, False
        worker.first = state.args[0] if state.args else None
        choose(blocks.values(), worker.first)
        waiting = list(blocks.items())
        while waiting:
            _, block = waiting.pop()
            for i, statement in enumerate(block.body):
                value = statement.value if isinstance(statement, ir.Assign) else None
                if not isinstance(value, ir.Expr) or value.op != "call":
                    continue
                if guard(self._do_work, state, waiting, block, i, value, worker):
                    modified = True
                    break
        if modified:
            for dead in compute_cfg_from_blocks(blocks).dead_nodes():
                del blocks[dead]
            PostProcessor(state.func_ir).run()
            state.func_ir.blocks = simplify_CFG(blocks)
        return True


def _with_ours(manager: Any) -> Any:
    manager.passes = [
        (_Inline, description) if step is InlineInlinables else (step, description)
        for step, description in manager.passes
    ]
    return manager


def _untyped(state: Any) -> Any:
    return _with_ours(compiler.DefaultPassBuilder.define_untyped_pipeline(state))


class KernelCompiler(compiler.Compiler):
    """numba's pipeline but for names and inlining."""

    only_linked = False
    """Return True if callers contain the compiled kernel and nobody else runs it."""

    def define_pipelines(self) -> list[Any]:
        """Return the one pipeline."""
        managers = [_with_ours(manager) for manager in super().define_pipelines()]
        for manager in managers:
            manager.finalize()
        return managers

    def compile_extra(self, func: Callable[..., Any]) -> Any:
        """Compile as numba does, under a name that depends only on a function at the top of a module."""
        identity = bytecode.FunctionIdentity.from_function(func)
        if "<" not in identity.func_qualname:
            where = f"{identity.modname}.{identity.func_qualname}:{identity.firstlineno}"
            identity.unique_id = int(hashlib.sha256(where.encode()).hexdigest()[:12], 16)
            identity.unique_name = f"{identity.func_qualname}${identity.unique_id}"
        self.state.func_id = identity
        ExtractByteCode().run_pass(self.state)
        self.state.lifted = ()
        self.state.lifted_from = None
        if self.only_linked:
            self.state.library = self.state.targetctx.codegen().create_library(identity.func_qualname)
            self.state.library.only_linked = True
        return self._compile_bytecode()


class LinkedCompiler(KernelCompiler):
    """The same for kernels that their callers contain: no machine code is made of them alone."""

    only_linked = True
