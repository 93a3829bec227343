"""``mbsd check``: what in a model looks as if it was not meant, before anything is made of it."""

from __future__ import annotations

import msgspec

from mbsd import MechanismError
from mechanisms.stages.loading import loading
from shared.contract.quantity import counted
from shared.stage.console import say, warn
from shared.stage.paths import known_name


def run(name: str, as_json: bool = False) -> int:
    """Build the mechanism and look at it; 1 where something looks odd, notes apart.

    Raises UserError if it fails.
    """
    name = known_name(name)
    module, given = loading.load(name, "mechanism"), loading.params(name)
    with loading.author_code(name):
        m = module.build(given)
        everything = m.check()
        try:
            mobility = m.mobility()
        except MechanismError:  # which is among the findings
            mobility = None
    findings = [finding for finding in everything if not finding.is_note]
    if as_json:
        rows = [
            {"name": finding.name, "problem": finding.problem, "remedy": finding.remedy, "note": finding.is_note}
            for finding in everything
        ]
        print(msgspec.json.encode({"machine": name, "freedom": mobility and mobility.dof, "findings": rows}).decode())
        return int(bool(findings))
    for finding in everything:
        (say if finding.is_note else warn)("check", f"{name}: {finding}")
    joints, bodies = len(m.joints), len(m.bodies) - 1
    odd = counted(len(findings), "thing")
    looks = f"{odd} {'looks' if len(findings) == 1 else 'look'} odd" if findings else "nothing odd"
    freedom = str(mobility).splitlines()[0] if mobility else "not assembled"
    say("check", f"{name}: {counted(bodies, 'body')}, {counted(joints, 'joint')}, {freedom}; {looks}")
    return int(bool(findings))
