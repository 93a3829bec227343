"""The Makefile: its targets and its words."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from shared.stage.paths import ROOT
from tests.project.making import MAKEFILE, STAGES, planned, run


def test_help_is_the_default_and_has_a_line_for_every_target() -> None:
    done = run("make")
    assert done.stdout == run("make", "help").stdout
    listed = re.findall(r"^  (\S+) ", done.stdout, flags=re.MULTILINE)
    targets = [
        t.replace("-%", "-<name>") for t in re.findall(r"^([a-z][a-z-]*(?:-%)?):(?!=)", MAKEFILE, flags=re.MULTILINE)
    ]
    assert listed == [target for target in targets if target != "always"]
    wanted = "help check install list run-<name> solve-<name> parts-<name> clearance-<name> plot-<name> still-<name> "
    wanted += "poster-<name> frames-<name> film-<name> scene-<name> scene-ui-<name> run-all all new test lint bench "
    wanted += "bench-start bench-live readme-loop animate-<name> report-<name> glb-<name> contact-<name> gallery "
    wanted += "clean clean-all test-fast test-slow"
    assert set(wanted.split()) <= set(listed)
    assert max(map(len, done.stdout.splitlines())) <= 120


def test_run_is_the_straight_line_of_stages() -> None:
    plan = planned("run-four-bar")
    assert [line.split()[0] for line in plan] == list(STAGES)
    assert all(line.split()[1] == "four_bar" for line in plan)


@pytest.mark.parametrize("target", ["run", "solve", "plot", "still", "poster", "frames", "film", "scene", "scene-ui"])
def test_hyphens_and_underscores_are_one_name(target: str) -> None:
    assert planned(f"{target}-four-bar") == planned(f"{target}-four_bar")


@pytest.mark.parametrize("target", ["still", "poster", "frames", "film", "scene", "scene-ui"])
def test_picture_targets_take_the_preset(target: str) -> None:
    assert planned(f"{target}-four-bar")[-1].endswith("--preset=preview")
    assert planned(f"{target}-four-bar", "PRESET=final")[-1].startswith(f"{target} four_bar")
    assert planned(f"{target}-four-bar", "PRESET=final")[-1].endswith("--preset=final")


@pytest.mark.parametrize("target", ["still", "poster", "contact", "frames", "film", "scene", "scene-ui"])
def test_picture_targets_take_what_to_show(target: str) -> None:
    assert "--show" not in planned(f"{target}-four-bar")[-1]
    assert planned(f"{target}-four-bar", "SHOW=reactions,title")[-1].endswith(" --show=reactions,title")


@pytest.mark.parametrize("target", ["run", "film"])
def test_films_take_whether_they_have_a_sound(target: str) -> None:
    assert "--sound" not in planned(f"{target}-four-bar")[-1]
    assert planned(f"{target}-four-bar", "SOUND=off")[-1].endswith(" --sound=off")
    assert "--sound" not in " ".join(planned("frames-four-bar", "SOUND=off"))


@pytest.mark.parametrize("target", ["run", "plot", "compare"])
def test_what_draws_plots_takes_the_spectra(target: str) -> None:
    stage = "compare" if target == "compare" else "plots"
    [plain] = [line for line in planned(f"{target}-belt-drive") if line.startswith(stage)]
    assert "--spectra" not in plain
    [asked] = [
        line for line in planned(f"{target}-belt-drive", "SPECTRA=shaking force,motor") if line.startswith(stage)
    ]
    assert asked == f"{stage} belt_drive --spectra=shaking force,motor"


def test_a_contact_sheet_is_of_drafts_unless_asked_otherwise() -> None:
    assert planned("contact-four-bar")[-1] == "contact four_bar --preset=draft"
    assert planned("contact-four-bar", "PRESET=preview")[-1] == "contact four_bar --preset=preview"


def test_a_still_takes_its_frame() -> None:
    assert "--frame=15" in planned("still-four-bar", "FRAME=15")[-1]


def test_each_target_runs_what_it_stands_on() -> None:
    assert [line.split()[0] for line in planned("parts-four-bar")] == ["parts"]
    assert planned("print-four-bar", "BED=180x180")[-1] == "print four_bar --bed=180x180"
    assert [line.split()[0] for line in planned("print-four-bar")] == ["parts", "print"]
    model = planned("print-four-bar", "SCALE=1:2", "BED=180x180")
    assert [line.split()[0] for line in model] == ["parts", "parts", "print", "solve", "clearance"]
    assert [line.endswith("--scale=1:2") for line in model] == [False, True, True, False, True]
    assert planned("parts-four-bar", "SCALE=1:2", "ANYWAY=1")[-1] == "parts four_bar --scale=1:2 --anyway=1"
    assert planned("clearance-four-bar", "SCALE=1:2")[-1] == "clearance four_bar --scale=1:2"
    assert not any("scale" in line for line in planned("film-four-bar", "SCALE=1:2"))
    assert [line.split()[0] for line in planned("solve-four-bar")] == ["parts", "solve"]
    assert [line.split()[0] for line in planned("clearance-four-bar")] == ["parts", "solve", "clearance"]
    assert [line.split()[0] for line in planned("plot-four-bar")] == ["parts", "solve", "plots"]
    assert [line.split()[0] for line in planned("film-four-bar")] == ["parts", "solve", "shot", "film"]
    assert [line.split()[0] for line in planned("compare-belt-drive")][-1] == "compare"


@pytest.mark.parametrize("preset", ["big", "draft preview final x"])
def test_an_unknown_preset_is_refused_with_the_known_ones(preset: str) -> None:
    done = run("make", "help", f"PRESET={preset}")
    assert done.returncode != 0
    assert "choose one of: draft preview production final" in done.stderr


def test_an_aspect_reaches_every_picture_and_an_unknown_one_is_refused_with_the_known_ones() -> None:
    for target in ("film", "frames", "still", "poster", "contact", "scene", "scene-ui", "run"):
        assert "--aspect=9:16" in planned(f"{target}-four-bar", "ASPECT=9:16")[-1]
        assert "aspect" not in planned(f"{target}-four-bar")[-1]
    for wrong in ("3:2", "9:16 1:1", "16/9"):
        done = run("make", "help", f"ASPECT={wrong}")
        assert done.returncode != 0
        assert "choose one of: 16:9 1:1 4:5 9:16" in done.stderr


def test_an_unknown_mechanism_is_refused_with_the_known_ones() -> None:
    done = run("make", "-o", "install", "run-nope")
    assert done.returncode != 0
    assert re.search(r"error: there is no mechanism 'nope' in mechanisms/; there is: .*four_bar", done.stderr)
    assert "Traceback" not in done.stderr


def test_compare_solves_a_mechanism_and_each_of_its_variants() -> None:
    assert planned("compare-belt-drive") == [
        "parts belt_drive --if-needed=motion", "solve belt_drive",
        "parts belt_drive-crossed --if-needed=motion", "solve belt_drive-crossed",
        "parts belt_drive-chain --if-needed=motion", "solve belt_drive-chain", "compare belt_drive",
    ]  # fmt: skip
    done = run("make", "-o", "install", "compare-nope")
    assert done.returncode != 0
    assert "there is no mechanism 'nope'" in done.stderr
    done = run("make", "-o", "install", "compare-pantograph")
    assert done.returncode != 0
    assert "pantograph: there is nothing to compare; write VARIANTS" in done.stderr
    assert done.stdout == ""  # nothing is made or solved before


def test_an_unknown_kind_of_new_mechanism_is_refused() -> None:
    done = run("make", "-o", "install", "new", "NAME=my_linkage", "KIND=simulatd")
    assert done.returncode != 0
    assert "did you mean 'simulated'?" in done.stderr


def test_new_without_a_name_says_what_to_write() -> None:
    done = run("make", "-o", "install", "new")
    assert done.returncode != 0
    assert "make new NAME=my_linkage" in done.stderr
    assert "four_bar" in done.stderr


def test_the_makefile_keeps_to_make_3_81_and_a_posix_shell() -> None:
    newer = (
        r"\.ONESHELL",
        r"!=",
        r"\$\(file ",
        r"^undefine",
        r"::=",
        r"\.SHELLSTATUS",
        r"\$\(let ",
        r"\$\(intcmp ",
        r"&:",
    )
    for construct in newer:
        assert not re.search(construct, MAKEFILE, flags=re.MULTILINE), construct
    # 3.81 takes the first pattern that fits, later ones take the longest.
    assert MAKEFILE.index("\nscene-ui-%:") < MAKEFILE.index("\nscene-%:")
    shell = shutil.which("dash") or "sh"
    for script in sorted((ROOT / "tools").glob("*.sh")):
        assert run(shell, "-n", str(script)).returncode == 0, script
        assert not re.search(
            r"\[\[|^ *local |^ *function |<<<|\bpipefail\b|\$'", script.read_text(), flags=re.MULTILINE
        ), script


def test_tests_and_measurements_wait_for_all_kernels() -> None:
    for target in ("test", "test-fast", "test-slow", "bench-start", "check-numbers", "check-events"):
        done = run("make", "-n", "-o", "install", target)
        [line] = [number for number, text in enumerate(done.stdout.splitlines()) if "-m tools.compiling wait" in text]
        assert line == (1 if target.startswith("test") else 0), (
            "before the first test, after a word on missing programs"
        )


def test_what_makes_parts_or_pictures_ends_before_it_begins_where_libraries_are_missing(tmp_path: Path) -> None:
    """install leaves a file where all were found; what needs none of them goes on."""
    shutil.copy(ROOT / "Makefile", tmp_path)
    (tmp_path / ".venv").mkdir()
    for target in ("run-four-bar", "film-four-bar", "parts-four-bar", "overnight"):
        done = run("make", "-o", "install", "PYTHON=echo", target, cwd=tmp_path)
        assert done.returncode != 0
        assert "error: parts and pictures need these libraries; nothing was made" in done.stderr
        assert done.stdout == ""
    assert run("make", "-o", "install", "PYTHON=echo", "animate-four-bar", cwd=tmp_path).returncode == 0
    (tmp_path / ".venv" / "libraries-found").touch()
    assert run("make", "-o", "install", "PYTHON=echo", "run-four-bar", cwd=tmp_path).returncode == 0
