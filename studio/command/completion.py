"""Scripts for shells that complete commands, options and the names of mechanisms."""

from __future__ import annotations

from studio.command.stages import OPTIONS
from studio.command.table import COMMANDS

BASH = """\
_mbsd() {{
    local word=${{COMP_WORDS[COMP_CWORD]}} command=${{COMP_WORDS[1]}}
    if [ "$COMP_CWORD" -eq 1 ]; then
        COMPREPLY=($(compgen -W "{commands}" -- "$word"))
        return
    fi
    case "${{COMP_WORDS[COMP_CWORD - 1]}}" in
{choices}
    esac
    case "$command" in
{options}
    esac
    case "$command" in
        {machines})
            if [ "$COMP_CWORD" -eq 2 ]; then
                words="$words $(mbsd list --names 2>/dev/null)"
            fi ;;
    esac
    COMPREPLY=($(compgen -W "$words" -- "$word"))
}}
complete -o default -F _mbsd mbsd
"""
ZSH = """\
(( $+functions[compdef] )) || { autoload -U +X compinit && compinit -u; }
autoload -U +X bashcompinit && bashcompinit
"""
FISH = """\
function __mbsd_is_first
    test (count (commandline -opc)) -eq 1
end
complete -c mbsd -f
{lines}
"""


def script(shell: str) -> str:
    """Return the script for bash, zsh or fish.

    ``eval "$(mbsd completion bash)"`` in a file such as ~/.bashrc loads it.
    """
    if shell == "fish":
        return FISH.format(lines="\n".join(_fish()))
    options = "\n".join(f'        {name}) words="{" ".join(_options(name))}" ;;' for name in COMMANDS)
    machines = "|".join(name for name, command in COMMANDS.items() if command.of == "machine")
    bash = BASH.format(commands=" ".join(COMMANDS), choices=_choices(), options=options, machines=machines)
    return (ZSH if shell == "zsh" else "") + bash


def _choices() -> str:
    """Return the lines that complete the words of options with a fixed choice."""
    return "\n".join(
        f'        --{option.name}) COMPREPLY=($(compgen -W "{" ".join(option.choices)}" -- "$word")); return ;;'
        for option in OPTIONS.values()
        if option.choices
    )


def _options(name: str) -> list[str]:
    return [f"--{option}" for option in COMMANDS[name].options]


def _fish() -> list[str]:
    lines = []
    for name, command in COMMANDS.items():
        text = command.help.replace("'", "\\'")
        lines.append(f"complete -c mbsd -n __mbsd_is_first -a {name} -d '{text}'")
        used = f"'__fish_seen_subcommand_from {name}'"
        if command.of == "machine":
            lines.append(f"complete -c mbsd -n {used} -a '(mbsd list --names 2>/dev/null)'")
        lines += [f"complete -c mbsd -n {used} -l {option}{_fish_value(option)}" for option in command.options]
    return lines


def _fish_value(name: str) -> str:
    """Return what may follow an option in fish: one of some words, any word, or nothing."""
    option = OPTIONS[name]
    if option.choices:
        return f" -xa '{' '.join(option.choices)}'"
    return "" if option.flag else " -x"
