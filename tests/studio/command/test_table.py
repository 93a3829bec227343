"""One table of commands, of which ``mbsd --help`` and the Makefile are faces."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys

import pytest

from mechanisms.stages.export.stage import FORMATS
from render import usd
from shared.stage.paths import ROOT
from studio.command import completion
from studio.command.main import parser
from studio.command.place import Settings
from studio.command.stages import OPTIONS
from studio.command.table import COMMANDS
from tests.project.test_injection import NASTY

MAKEFILE = (ROOT / "Makefile").read_text()


@pytest.mark.parametrize("name", COMMANDS)
def test_the_makefile_gives_every_command_with_the_same_words(name: str) -> None:
    command = COMMANDS[name]
    target = re.escape(command.make_target.replace("-<name>", "-%"))
    rule = re.search(rf"^{target}: [^#\n]*## (.*)\n\t(.*)\n(?!\t)", MAKEFILE, re.MULTILINE)
    assert rule is not None, f"make has no {target}"
    assert rule[1].startswith(command.help)
    assert rule[2].startswith(f"@$(MBSD) {name}")


def test_every_option_has_a_variable_that_the_makefile_exports() -> None:
    exported = set(re.findall(r"\w+", " ".join(re.findall(r"^export ([A-Z_ ]+)$", MAKEFILE, re.MULTILINE))))
    by_command_line_alone = {"single", "port", "limit", "no-parts", "open", "names", "json"}
    missing = {name for name, option in OPTIONS.items() if option.variable not in exported}
    assert missing == by_command_line_alone


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_has_a_help_with_its_options(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        parser().parse_args([name, "--help"])
    assert ended.value.code == 0
    said = capsys.readouterr().out
    assert all(f"--{option}" in said for option in COMMANDS[name].options)


def test_every_stage_takes_what_the_table_gives_it() -> None:
    """The stages' own command lines know these options."""
    stages = {(stage.room, stage.name): stage for command in COMMANDS.values() for stage in command.stages}
    for (room, name), stage in stages.items():
        words = [sys.executable, "-m", room, *filter(None, [name]), "--help"]
        said = subprocess.run(words, cwd=ROOT, capture_output=True, text=True)
        assert said.returncode == 0, said.stderr
        for option in stage.options:
            assert f"--{option}" in said.stdout, (room, name)


@pytest.mark.parametrize("word", NASTY)
def test_words_of_make_reach_a_stage_as_they_are(word: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FRAME", word)
    asked = parser(make=True).parse_args(["still", "--", "four_bar"])
    assert (asked.operand, asked.frame) == ("four_bar", word)
    still = COMMANDS["still"].stages[-1]
    assert f"--frame={word}" in still.words("four_bar", {"frame": asked.frame})


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_scripts_of_completion_name_all_commands(shell: str) -> None:
    script = completion.script(shell)
    assert all(re.search(rf"\b{name}\b", script) for name in COMMANDS)


def test_bash_completes_commands_options_and_machines(tmp_path) -> None:
    script = tmp_path / "completion"
    script.write_text(completion.script("bash"))
    code = f"""
    mbsd() {{ echo excavator; echo loader; }}
    . {script}
    complete_of() {{ COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _mbsd; echo "${{COMPREPLY[@]}}"; }}
    complete_of mbsd sol; complete_of mbsd run ex; complete_of mbsd film excavator --as
    complete_of mbsd film excavator --preset pre
    """
    done = subprocess.run(["bash", "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split("\n")[:4] == ["solve", "excavator", "--aspect", "preview"]


@pytest.mark.skipif(not shutil.which("fish"), reason="there is no fish")
def test_fish_completes_commands_options_machines_and_choices(tmp_path) -> None:
    script = tmp_path / "mbsd.fish"
    script.write_text(completion.script("fish"))
    asked = ["mbsd sol", "mbsd run ex", "mbsd film excavator --as", "mbsd film excavator --preset pre"]
    code = f"function mbsd; echo excavator; end; source {script}\n"
    code += "\n".join(f"complete -C '{line}' | string split -f1 \\t" for line in asked)
    done = subprocess.run(["fish", "--no-config", "-c", code], capture_output=True, text=True)
    assert done.stdout.split() == ["solve", "excavator", "--aspect", "preview"], done.stderr


@pytest.mark.skipif(not shutil.which("zsh"), reason="there is no zsh")
def test_zsh_takes_the_script_in_with_and_without_its_own_completion(tmp_path) -> None:
    script = tmp_path / "completion"
    script.write_text(completion.script("zsh"))
    for before in ("", "autoload -U compinit && compinit -u;"):
        code = f"{before} source {script}; print $_comps[mbsd]"
        done = subprocess.run(["zsh", "-f", "-c", code], capture_output=True, text=True, env={"HOME": str(tmp_path)})
        assert done.stderr == ""
        assert "_mbsd" in done.stdout


def test_formats_and_settings_are_those_that_are_there() -> None:
    assert OPTIONS["format"].choices == (*FORMATS, *usd.FORMATS)
    assert {name for name, option in OPTIONS.items() if option.kept} <= set(Settings.__struct_fields__)
