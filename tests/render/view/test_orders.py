"""The page of an engine has bars of its orders, which say what the solution says."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path

from mbsd.results.orders import Orders
from render.view.bundle import PAGE, bundle, node, node_modules
from render.view.document import document, encode
from render.view.payload import payload
from shared.contract.quantity import written
from tests.render.test_shaking import motion_of
from tests.results.test_couples import two_cylinders
from tests.running.needs import needed
from tools.models.motions import plain_skeleton


def largest(orders: Orders, unit: str, order: float) -> str:
    return f"order {order:g} {written(float(orders.largest[orders.index(order)]), unit)}"


def test_bars_name_the_largest_orders_of_what_is_chosen(tmp_path: Path) -> None:
    chromium = needed("chromium")
    m = two_cylinders()
    m.bodies["piston_1"].mass = 0.7
    motion, sol = motion_of(m), m.sweep(steps=360)
    content = encode(payload(motion, plain_skeleton(motion).moving))
    (tmp_path / "view.html").write_bytes(document("Twin", content, bundle()))
    done = subprocess.run(
        [str(node()), str(Path(__file__).with_name("orders.cjs")), str(tmp_path / "view.html")],
        env=os.environ
        | {
            "NODE_PATH": str(node_modules()),
            "CHROMIUM": str(chromium),
            "PAGE_BROWSER": str(PAGE / "browser" / "browser.cjs"),
        },
        capture_output=True, text=True, timeout=200, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr[-3000:]
    seen = json.loads(done.stdout)
    assert not seen["errors"]
    shown = {chart["title"]: chart for chart in seen["whole"]}
    force, torque = sol.orders(sol.shaking().force), sol.orders(sol.driver("motor").effort)
    assert shown["Orders of the shaking force"]["named"][:2] == [largest(force, "N", order) for order in (2, 1)]
    assert shown["Orders of motor"]["named"][0] == largest(torque, "N m", 2)
    assert all(chart["inked"] for chart in seen["whole"])
    (driver,) = seen["driver"]
    assert driver["title"] == "Orders of the effort"
    assert driver["named"] == shown["Orders of motor"]["named"]
    assert not seen["body"]
