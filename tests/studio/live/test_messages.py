"""Messages of pages: a hostile page gets a sentence, and the others notice nothing."""

from __future__ import annotations

import json
import time

import httpx
import pytest
from websockets.exceptions import ConnectionClosed

from shared.stage.errors import UserError
from studio.live import messages
from studio.live.messages import Cancel, Drag, Fit, Mailbox, Set, Thing, Write, wish_of
from tests.studio.live.served import Page, Served, live_server

P = '"thing": {"kind": "point", "name": "P"}, "time": 0'
HOSTILE = [
    "",
    "no json",
    "[]",
    "5",
    "null",
    "{}",
    '{"do": null}',
    '{"do": ["set"]}',
    '{"do": {"set": 1}}',
    '{"do": "fly"}',
    '{"do": "open"}',
    '{"do": "numbers"}',
    '{"do": "undo", "more": 1}',
    '{"do": "set"}',
    '{"do": "set", "values": []}',
    '{"do": "set", "values": {"length": null}}',
    '{"do": "set", "values": {"length": "0.3"}}',
    '{"do": "set", "values": {"length": true}}',
    '{"do": "set", "values": {"length": NaN}}',
    '{"do": "set", "values": {"length": Infinity}}',
    '{"do": "set", "values": {"length": 1e999}}',
    '{"do": "set", "values": {"length": 1e100}}',
    f'{{"do": "set", "values": {{"length": {"9" * 5000}}}}}',
    '{"do": "set", "values": {"length": [0.3]}}',
    '{"do": "set", "values": {"": 0.3}}',
    f'{{"do": "set", "values": {{"{"a" * 201}": 0.3}}}}',
    '{"do": "set", "values": {"length": 0.3}, "final": "yes"}',
    '{"do": "drag"}',
    f'{{"do": "drag", {P}}}',
    f'{{"do": "drag", {P}, "to": 5}}',
    f'{{"do": "drag", {P}, "to": [1]}}',
    f'{{"do": "drag", {P}, "to": [1, 2, 3]}}',
    f'{{"do": "drag", {P}, "to": [[1], {{}}]}}',
    f'{{"do": "drag", {P}, "to": [1, null]}}',
    '{"do": "drag", "thing": {"kind": ["point"], "name": "P"}, "time": 0, "to": [0, 0]}',
    '{"do": "drag", "thing": {"kind": "body", "name": "crank"}, "time": 0, "to": [0, 0]}',
    '{"do": "drag", "thing": "P", "time": 0, "to": [0, 0]}',
    '{"do": "write", "names": 5}',
    '{"do": "write", "names": [["length"]]}',
    '{"do": "fit"}',
    '{"do": "fit", "point": "P", "path": []}',
    '{"do": "fit", "point": "P", "path": [[0, 0], [1]]}',
    '{"do": "fit", "point": "P", "path": [[0, 0], 1]}',
    f'{{"do": "fit", "point": "P", "path": {[[0, 0]] * 1001}}}',
    '{"do": "fit", "point": "P", "path": [[0, 0], [1, 1]], "starts": 0}',
    '{"do": "fit", "point": "P", "path": [[0, 0], [1, 1]], "starts": 1e9}',
    '{"do": "fit", "point": "P", "path": [[0, 0], [1, 1]], "generations": -1}',
    '{"do": "fit", "point": "P", "path": [[0, 0], [1, 1]], "vary": {"length": [1]}}',
    '{"do": "fit", "point": "P", "path": [[0, 0], [1, 1]], "least_transmission": 2}',
    "[" * 200_000,
    '{"do": "set", "values": ' + '{"a":' * 100_000,
    "\ud800",
]


@pytest.mark.parametrize("text", HOSTILE, ids=lambda text: text[:60].encode("ascii", "replace").decode())
def test_every_other_message_is_refused_in_a_sentence(text: str) -> None:
    with pytest.raises(UserError, match="the page's message is") as refused:
        wish_of(text)
    assert len(str(refused.value)) < 500


def test_messages_of_the_page_are_understood() -> None:
    assert wish_of('{"do": "set", "values": {"a": 1}, "final": true}') == Set(values={"a": 1.0}, final=True)
    assert wish_of(f'{{"do": "drag", {P}, "to": [1, 2.5], "arrows": true}}') == Drag(
        thing=Thing("point", "P"), time=0.0, to=(1.0, 2.5), arrows=True
    )
    assert wish_of(b'{"do": "write"}') == Write()
    assert isinstance(wish_of('{"do": "fit", "point": "P", "path": [[0, 0], [1, 1]], "grashof": false}'), Fit)
    assert wish_of('{"do": "cancel"}') == Cancel()


live = live_server("hostile")


def set_and_seen(page: Page, other: Page, length: float) -> None:
    """Set a number on one page and wait until another one shows it."""
    page.say(do="set", values={"length": length}, final=True)
    other.hear("values", wanted=lambda header: header["values"] == {"length": length})
    other.hear("motion", wanted=lambda header: header["values"] == {"length": length})


def test_hostile_messages_leave_page_and_history_as_they_were(live: Served) -> None:
    history = live.session.history
    with live.page() as page, live.page() as other:
        before = history.now
        for text in HOSTILE[1:-1]:
            page._socket.send(text)
            assert page.hear("refused")["text"]
        page._socket.send(b"\xff\xfe")
        assert page.hear("refused")["text"]
        for wish in (
            {"do": "set", "values": {"length": 0.3, "lenght": 0.3}, "final": True},
            {"do": "write", "names": ["lenght"]},
            {"do": "fit", "point": "P", "path": [[0, 0], [0.1, 0.1]], "vary": {"lenght": [0, 1]}},
        ):
            page.say(**wish)
            assert "no number 'lenght'; it has: length, speed" in page.hear("refused")["text"]
        assert history.now == before
        assert not history.can_undo
        set_and_seen(page, other, 0.21)
        set_and_seen(other, page, 0.22)
    assert set(history.now) == {"length"}


def test_a_message_of_a_hundred_megabytes_costs_its_page_alone(live: Served) -> None:
    with live.page() as other:
        with live.page() as page:
            page.hear("state")
            try:
                page._socket.send(json.dumps({"do": "set", "values": {"length": 0.3}}) + " " * 100_000_000)
                while True:
                    page.hear("none")
            except ConnectionClosed:
                pass
        with live.page() as page:
            set_and_seen(page, other, 0.23)


def test_a_flood_of_messages_keeps_nobody_else_waiting(live: Served) -> None:
    with live.page() as page, live.page() as other:
        for k in range(1000):
            page.say(do="undo" if k % 2 else "redo")
        began = time.monotonic()
        assert httpx.get(live.live.address).status_code == 200
        assert time.monotonic() - began < 20
        page.say(do="set", values={"length": 0.24}, final=True)
        other.hear("motion", "state", wanted=lambda header: header["values"] == {"length": 0.24})


def test_a_page_that_is_too_slow_gets_the_state_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    """No single message is dropped, since it could report that an error is cured."""
    box = Mailbox(lambda: [b"state"])
    for k in range(messages.MOST):
        box.add(b"%d" % k)
    assert len(box) == messages.MOST
    box.add(b"one more")
    assert len(box) == 1
    monkeypatch.setattr(messages, "MOST_BYTES", 100)
    for _ in range(50):
        box.add(b"x" * 40, replaces=True)
    assert len(box) == 2
    box.add(b"x" * 90)
    assert len(box) == 1
