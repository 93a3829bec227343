"""``mbsd check``: what in a model looks as if it was not meant, before anything is made of it."""

from __future__ import annotations

import msgspec

from mbsd import MechanismError
from mechanisms.stages.loading import loading
from shared.stage.console import say, warn
from shared.stage.paths import known_name


def run(name: str, as_json: bool = False) -> int:
    """Build the mechanism and look at it; 1 where something looks odd. Raises UserError where it cannot be built."""
    name = known_name(name)
    module, given = loading.load(name, "mechanism"), loading.params(name)
    with loading.author_code(name):
        m = module.build(given)
        findings = [(finding.name, finding.problem, finding.remedy) for finding in m.check()]
        try:
            mobility = m.mobility()
        except MechanismError:  # which is among the findings
            mobility = None
    if as_json:
        rows = [{"name": where, "problem": problem, "remedy": remedy} for where, problem, remedy in findings]
        print(msgspec.json.encode({"machine": name, "freedom": mobility and mobility.dof, "findings": rows}).decode())
        return int(bool(findings))
    for where, problem, remedy in findings:
        warn("check", f"{name}: {where}: {problem}. {remedy}")
    joints, bodies = len(m.joints), len(m.bodies) - 1
    looks = f"{len(findings)} things look odd" if len(findings) > 1 else "one looks odd" if findings else "nothing odd"
    freedom = str(mobility).splitlines()[0] if mobility else "not assembled"
    say("check", f"{name}: {bodies} bodies, {joints} joints, {freedom}; {looks}")
    return int(bool(findings))
