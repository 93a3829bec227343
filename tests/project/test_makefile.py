"""The Makefile: its targets, its words, and an installation that does nothing twice."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from shared.stage.paths import ROOT

MAKEFILE = (ROOT / "Makefile").read_text()
STAGES = ("parts", "solve", "clearance", "shot", "report", "plots", "glb", "poster", "film")


def run(*command: str, cwd: Path = ROOT, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run a command free of the make that may have started the tests, and of the words that it exports."""
    words = re.findall(r"^export (.*)$", MAKEFILE, flags=re.MULTILINE)[0].split()
    makes = {"MAKEFLAGS", "MAKELEVEL", "MFLAGS", "MBSD_MAKE", *words}
    inherited = {key: value for key, value in os.environ.items() if key not in makes}
    return subprocess.run(command, cwd=cwd, capture_output=True, text=True, env=inherited | environment)


def planned(*arguments: str) -> list[str]:
    """The stages that make would run, in order: ``parts four_bar``."""
    done = run("make", "-o", "install", "PYTHON=echo", *arguments)
    assert done.returncode == 0, done.stderr
    return re.findall(r"-m (?:mechanisms|render) (.*)", done.stdout)


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
    wanted += "bench-start animate-<name> report-<name> glb-<name> contact-<name> gallery clean clean-all"
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
    assert planned(f"{target}-four-bar")[-1].endswith("--preset preview")
    assert planned(f"{target}-four-bar", "PRESET=final")[-1].startswith(f"{target} four_bar")
    assert planned(f"{target}-four-bar", "PRESET=final")[-1].endswith("--preset final")


@pytest.mark.parametrize("target", ["still", "poster", "contact", "frames", "film", "scene", "scene-ui"])
def test_picture_targets_take_what_to_show(target: str) -> None:
    assert "--show" not in planned(f"{target}-four-bar")[-1]
    assert planned(f"{target}-four-bar", "SHOW=reactions,title")[-1].endswith(" --show=reactions,title")


@pytest.mark.parametrize("target", ["run", "plot", "compare"])
def test_what_draws_plots_takes_the_spectra(target: str) -> None:
    stage = "compare" if target == "compare" else "plots"
    [plain] = [line for line in planned(f"{target}-four-bar") if line.startswith(stage)]
    assert "--spectra" not in plain
    [asked] = [line for line in planned(f"{target}-four-bar", "SPECTRA=shaking force,motor") if line.startswith(stage)]
    assert asked == f"{stage} four_bar --spectra=shaking force,motor"
    [one] = [line for line in planned(f"{target}-four-bar", "SPECTRA=motor", "EVERY=1") if line.startswith(stage)]
    assert one == f"{stage} four_bar --spectra=motor --every"


def test_a_contact_sheet_is_of_drafts_unless_asked_otherwise() -> None:
    assert planned("contact-four-bar")[-1] == "contact four_bar --preset draft"
    assert planned("contact-four-bar", "PRESET=preview")[-1] == "contact four_bar --preset preview"


def test_a_still_takes_its_frame() -> None:
    assert "--frame=15" in planned("still-four-bar", "FRAME=15")[-1]


def test_each_target_runs_what_it_stands_on() -> None:
    assert [line.split()[0] for line in planned("parts-x")] == ["parts"]
    assert planned("print-four-bar", "BED=180x180")[-1] == "print four_bar --bed=180x180 --gap="
    assert [line.split()[0] for line in planned("print-x")] == ["parts", "print"]
    assert [line.split()[0] for line in planned("solve-x")] == ["parts", "solve"]
    assert [line.split()[0] for line in planned("clearance-x")] == ["parts", "solve", "clearance"]
    assert [line.split()[0] for line in planned("plot-x")] == ["parts", "solve", "plots"]
    assert [line.split()[0] for line in planned("film-x")] == ["parts", "solve", "shot", "film"]
    assert [line.split()[0] for line in planned("compare-x")][-1] == "compare"


@pytest.mark.parametrize("preset", ["big", "draft preview final x", ""])
def test_an_unknown_preset_is_refused_with_the_known_ones(preset: str) -> None:
    done = run("make", "help", f"PRESET={preset}")
    assert done.returncode != 0
    assert "choose one of: draft preview production final" in done.stderr


def test_an_unknown_mechanism_is_refused_with_the_known_ones() -> None:
    done = run("make", "-o", "install", "run-nope")
    assert done.returncode != 0
    assert re.search(r"error: there is no mechanism 'nope' in mechanisms/; there is: .*four_bar", done.stderr)
    assert "Traceback" not in done.stderr


def test_compare_solves_a_mechanism_and_each_of_its_variants(tmp_path: Path) -> None:
    said = tmp_path / "python"
    said.write_text('#!/bin/sh\ncase "$3" in variants) printf "a_b\\na_b-c\\n";; *) echo "ran $3 $4";; esac\n')
    said.chmod(0o755)
    done = run("make", "-o", "install", f"PYTHON={said}", "compare-a-b")
    assert re.findall("ran .*", done.stdout) == [
        "ran parts a_b", "ran solve a_b", "ran parts a_b-c", "ran solve a_b-c", "ran compare a_b",
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


def test_the_locks_hold_hashes_and_no_addresses() -> None:
    for lock in ("requirements.lock", "requirements-bench.lock"):
        text = (ROOT / lock).read_text()
        assert not re.search(r"https?:|file:|^-|--index|--find-links", text, flags=re.MULTILINE)
        for block in re.split(r"\n(?=\S)", text.strip()):
            assert re.match(r"[a-z0-9._-]+==\S+( ; .*)? \\\n    --hash=sha256:[0-9a-f]{64}", block), block[:200]


def test_the_benchmarks_add_to_the_locked_versions_and_change_none() -> None:
    from tools.check import locked

    main, bench = locked(ROOT / "requirements.lock"), locked(ROOT / "requirements-bench.lock")
    assert {"exudyn", "pylinkage"} <= set(bench)
    assert all(main[name] == version for name, version in bench.items() if name in main)


class Tree:
    """A copy of the bootstrap in a folder of its own, with a uv that writes down what it is asked for."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        shutil.copytree(ROOT / "tools", folder / "tools")
        (folder / "mbsd").mkdir()
        (folder / "mbsd" / "__main__.py").write_text("import sys; print('mbsd', *sys.argv[1:])\n")
        self.lock = folder / "requirements.lock"
        self.lock.write_text("numpy==2.5.5\n")
        (folder / "requirements-bench.lock").write_text("exudyn==1\n")
        self.bin = folder / "bin"
        self.bin.mkdir()
        self.asked = folder / "asked"
        self.uv("exit 0")

    def uv(self, sync: str) -> None:
        """Install a uv that makes the environment from the Python of the tests and answers a sync with ``sync``."""
        script = f"""#!/bin/sh
        [ "$1" = --version ] && exit 0
        echo "$@" >>{self.asked}
        if [ "$1" = venv ]; then
            mkdir -p .venv/bin
            printf '#!/bin/sh\\nexec {sys.executable} "$@"\\n' >.venv/bin/python
            chmod +x .venv/bin/python
        else
            {sync}
        fi
        """
        (self.bin / "uv").write_text(script)
        (self.bin / "uv").chmod(0o755)

    def install(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        self.asked.unlink(missing_ok=True)
        path = f"{self.bin}:{os.environ['PATH']}"
        return run("sh", "tools/install.sh", *arguments, cwd=self.folder, PATH=path, HOME=str(self.folder))

    def python(self, module: str, *arguments: str) -> subprocess.CompletedProcess[str]:
        """Run a module of the folder."""
        return run(str(self.folder / ".venv" / "bin" / "python"), "-m", module, *arguments, cwd=self.folder)

    @property
    def calls(self) -> list[str]:
        """The first two words of each call."""
        lines = self.asked.read_text().splitlines() if self.asked.exists() else []
        return [" ".join(line.split()[:2]) for line in lines]


@pytest.fixture
def tree(tmp_path: Path) -> Tree:
    return Tree(tmp_path)


def test_install_makes_the_environment_once(tree: Tree) -> None:
    first = tree.install()
    assert first.returncode == 0, first.stderr
    assert tree.calls == ["venv --quiet", "pip sync", "pip install"]
    assert "--require-hashes requirements.lock" in tree.asked.read_text()
    assert "compiling the solver's kernels in the background" in first.stdout
    assert tree.python("tools.compiling", "wait").returncode == 0
    assert (tree.folder / ".venv" / "kernels.log").read_text() == "mbsd compile\n"
    again = tree.install()
    assert (again.returncode, again.stdout, again.stderr, tree.calls) == (0, "", "", [])


def test_install_follows_the_content_of_the_lock(tree: Tree) -> None:
    tree.install()
    os.utime(tree.lock)
    tree.install()
    assert tree.calls == []
    tree.lock.write_text("numpy==2.5.6\n")
    tree.install()
    assert tree.calls == ["pip sync", "pip install"]


def test_a_failed_install_is_told_and_tried_again(tree: Tree) -> None:
    tree.uv("echo no network >&2; exit 2")
    failed = tree.install()
    assert failed.returncode == 1
    assert "no network" in failed.stderr
    assert "error: the packages of requirements.lock could not be installed" in failed.stderr
    tree.uv("exit 0")
    assert tree.install().returncode == 0
    assert tree.calls == ["pip sync", "pip install"]


def test_the_solver_is_there_for_scripts_in_any_folder(tree: Tree, tmp_path: Path) -> None:
    """Also where the environment stands already, and again after the packages changed."""
    tree.install()
    assert "--editable ." in tree.asked.read_text()
    (tree.folder / ".venv" / "solver-installed").unlink()
    tree.install()
    assert tree.calls == ["pip install"]
    code = "import mbsd; print(mbsd.__file__)"
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    told = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path / "bin", env=environment, capture_output=True, text=True
    )
    assert Path(told.stdout.strip()).name == "__init__.py", told.stderr


def test_a_failed_compilation_is_told_by_who_waits_and_by_the_next_install(tree: Tree) -> None:
    (tree.folder / "mbsd" / "__main__.py").write_text("raise SystemExit('no room')\n")
    assert tree.install().returncode == 0
    waited = tree.python("tools.compiling", "wait")
    assert (waited.returncode, waited.stderr) == (1, "no room\n")
    again = tree.install()
    assert again.returncode == 0
    assert re.search(r"warning: kernels were not compiled .*: no room \(.*kernels\.log\)", again.stderr)
    tree.python("tools.compiling", "wait")
    (tree.folder / "mbsd" / "__main__.py").write_text("")
    assert tree.python("tools.compiling", "wait").returncode == 0
    assert tree.install().stderr == ""


def test_kernels_are_compiled_once_beside_what_goes_on_and_waited_for(tree: Tree) -> None:
    """A second install starts none; a Ctrl-C at the terminal does not reach it; it has the lowest priority."""
    begun, go = tree.folder / "begun", tree.folder / "go"
    code = f"""
import os, time
with open({str(begun)!r}, "a") as file:
    file.write(f"{{os.nice(0)}} {{os.getsid(0) == {os.getsid(0)}}}\\n")
while not os.path.exists({str(go)!r}):
    time.sleep(0.01)
"""
    (tree.folder / "mbsd" / "__main__.py").write_text(code)
    assert "in the background" in tree.install().stdout
    assert tree.install().stdout == ""
    with subprocess.Popen(
        [sys.executable, "-m", "tools.compiling", "wait"], cwd=tree.folder, stdout=subprocess.PIPE, text=True
    ) as waiting:
        assert waiting.stdout is not None
        assert waiting.stdout.readline() == "install: waiting for the solver's kernels\n"
        assert waiting.poll() is None
        go.touch()
        assert waiting.wait(30) == 0
    assert begun.read_text() == "19 False\n"


def test_tests_and_measurements_wait_for_all_kernels() -> None:
    for target in ("test", "bench-start", "check-numbers"):
        done = run("make", "-n", "-o", "install", target)
        assert done.stdout.splitlines()[0].endswith("-m tools.compiling wait"), target


def test_an_environment_whose_python_is_gone_is_made_again(tree: Tree) -> None:
    tree.install()
    (tree.folder / ".venv" / "bin" / "python").unlink()
    tree.install()
    assert tree.calls == ["venv --quiet", "pip sync", "pip install"]


def test_a_missing_system_library_is_named_with_its_cure_until_it_is_there(tree: Tree) -> None:
    probe = tree.folder / "tools" / "system_libraries.py"
    text = probe.read_text()
    probe.write_text(text.replace('"libGL.so.1"', '"libNotThere.so.1"'))
    done = tree.install()
    assert done.returncode == 0
    if sys.platform == "linux":
        assert "missing system libraries libNotThere.so.1: sudo apt-get install -y libgl1\n" in done.stderr
        assert "libNotThere" in tree.install().stderr
    probe.write_text(text)
    tree.install()
    probe.unlink()  # found once, asked no more
    assert tree.install().returncode == 0


def test_the_peers_of_the_benchmarks_are_added_once(tree: Tree) -> None:
    tree.install()
    tree.install("bench")
    assert tree.calls == ["pip install"]
    tree.install("bench")
    assert tree.calls == []


def test_without_uv_and_without_a_network_the_remedy_is_told(tree: Tree) -> None:
    (tree.bin / "uv").write_text("#!/bin/sh\nexit 127\n")  # as a version manager's shim may do
    home = tree.folder / "home"
    home.mkdir()
    path = f"{tree.bin}:/usr/bin:/bin"
    no_network = {"PIP_NO_INDEX": "1", "PIP_FIND_LINKS": str(home), "PIP_BREAK_SYSTEM_PACKAGES": "1"}
    done = run("sh", "tools/install.sh", cwd=tree.folder, PATH=path, HOME=str(home), **no_network)
    assert done.returncode == 1
    assert "error: uv could not be installed" in done.stderr
    assert "brew install uv" in done.stderr
    assert not (tree.folder / ".venv-uv").exists()


def fake_make(folder: Path, *failing: str) -> Path:
    """Stands for make in run_all.sh: fails for the named targets."""
    script = folder / "make"
    script.write_text(
        f'#!/bin/sh\necho "made $2 $3 EVERY=$EVERY"\ncase " {" ".join(failing)} " in *" $2 "*) exit 1;; esac\n'
    )
    script.chmod(0o755)
    return script


def test_run_all_goes_on_after_a_failure_and_sums_up(tmp_path: Path) -> None:
    shutil.copytree(ROOT / "tools", tmp_path / "tools")
    for name in ("a_linkage", "b_linkage", "c_linkage"):
        (tmp_path / "mechanisms" / name).mkdir(parents=True)
        (tmp_path / "mechanisms" / name / "mechanism.py").touch()
    (tmp_path / "mechanisms" / "not_one").mkdir()
    done = run("sh", "tools/run_all.sh", str(fake_make(tmp_path)), "draft", cwd=tmp_path)
    assert done.returncode == 0
    assert done.stdout.count("PRESET=draft EVERY=1") == 3  # what one of them lacks is no failure
    assert done.stdout.endswith("run-all: 3 done\n")
    done = run("sh", "tools/run_all.sh", str(fake_make(tmp_path, "run-b_linkage")), "final", cwd=tmp_path)
    assert done.returncode == 1
    assert "made run-c_linkage PRESET=final" in done.stdout
    assert "run-all: 2 done, failed: b_linkage" in done.stderr


def test_clean_removes_the_results_and_leaves_a_folder_of_the_users_alone(tmp_path: Path) -> None:
    shutil.copytree(ROOT / "tools", tmp_path / "tools")
    (tmp_path / "out" / "four_bar").mkdir(parents=True)
    mine = tmp_path / "mine"
    mine.mkdir()
    done = run("sh", "tools/clean.sh", cwd=tmp_path, MBSD_OUT=str(mine))
    assert done.returncode == 0
    assert not (tmp_path / "out").exists()
    assert mine.exists()
    assert str(mine) in done.stderr
    (mine / "data.json").touch()
    (tmp_path / "out").symlink_to(mine)
    done = run("sh", "tools/clean.sh", cwd=tmp_path)
    assert (done.returncode, (tmp_path / "out").is_symlink(), (mine / "data.json").exists()) == (0, True, True)
    assert f"out is a link, so it and the folder it leads to are left to you: {mine}" in done.stderr


def test_check_tells_versions_libraries_disk_and_device() -> None:
    done = run("make", "-o", "install", "check")
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert [line.partition(":")[0] for line in lines] == [
        "python",
        "packages",
        "system libraries",
        "disk",
        "render device",
    ]
    assert re.search(r"numpy \d+\.\d+\.\d+, .*bpy 5\.2", lines[1])
    assert re.search(r"\d+ GB free", lines[3])
    assert re.search(r"(CPU|OPTIX|CUDA|HIP|METAL|ONEAPI).*, Blender 5\.2", lines[4])
