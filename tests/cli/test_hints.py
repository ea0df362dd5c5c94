"""Commands, options and numbers as other tools have them: a hint in the line of the mistake, and exit code 2."""

import pytest
from goniosim_cli import hints
from goniosim_cli.main import main


@pytest.mark.parametrize(
    "line, hint",
    [
        ("run scene.yaml", "No such command 'run': did you mean goniosim simulate?"),
        ("render scene.yaml", "No such command 'render': did you mean goniosim simulate?"),
        ("view small.h5", "No such command 'view': did you mean goniosim plot?"),
        ("simulat scene.yaml", "No such command 'simulat': did you mean goniosim simulate?"),
        ("scene.yaml", "No such command 'scene.yaml': did you mean goniosim simulate scene.yaml?"),
        ("small.h5", "No such command 'small.h5': did you mean goniosim info small.h5?"),
        ("help", "No such command 'help': did you mean goniosim --help?"),
        ("simulate scene.yaml --samples 100", "No such option '--samples': did you mean --rays?"),
        ("simulate scene.yaml --spp=100", "No such option '--spp': did you mean --rays?"),
        ("simulate scene.yaml -n 100", "No such option '-n': did you mean --rays?"),
        ("simulate scene.yaml --n-threads 1", "No such option '--n-threads': did you mean --threads?"),
        ("simulate scene.yaml --nthreads 1", "No such option '--nthreads': did you mean --threads?"),
        ("simulate scene.yaml --out a.h5", "No such option '--out': did you mean --output?"),
        ("simulate scene.yaml --seeed 1", "No such option '--seeed': did you mean --seed?"),
        ("simulate scene.yaml --theta 30", "No such option '--theta': --theta belongs to goniosim plot"),
        ("compare small.h5 --model ww09", "No such option '--model': did you mean --models?"),
        ("plot small.h5 --models ww09", "No such option '--models': did you mean --model?"),
        ("simulate scene.yaml --gpu", "No such option '--gpu': not available: rays are traced by the processor"),
        ("submit scene.yaml --partition=long", "options of sbatch stand behind --: -- --partition=long"),
        ("qsub scene.yaml", "No such command 'qsub': did you mean goniosim submit?"),
        ("simulate --config scene.yaml", "'--config': name the file behind the command, without an option"),
        ("simulate scene.yaml --version", "No such option '--version': --version stands before the command"),
        ("--rays 100 simulate scene.yaml", "--rays stands behind goniosim simulate, check, plan and submit"),
        ("plot small.h5 --theta 1,5", "Invalid value for '--theta': '1,5' has a comma: write 1.5"),
        ("simulate scene.yaml --rays 1,5e6", "Invalid value for '--rays': '1,5e6' has a comma: write 1.5e6"),
        ("simulate scene.yaml --rays 1,000,000", "'1,000,000' has a comma: write 1000000"),
        ("plot small.h5 --theta steep", "'steep' is not a number such as 22.5"),
    ],
)
def test_a_foreign_word_of_the_command_line(goniosim, folder, line, hint):
    code, out, err = goniosim(*line.split())
    assert (code, out) == (2, "")
    (said,) = [each for each in err.splitlines() if each.startswith("Error: ")]
    assert said.endswith(hint)


@pytest.mark.parametrize("line", ["banana", "simulate scene.yaml --banana"])
def test_what_nobody_knows_gets_no_hint(goniosim, folder, line):
    code, _, err = goniosim(*line.split())
    assert code == 2
    assert "No such" in err
    assert "did you mean" not in err


def test_the_tables_lead_to_what_exists():
    assert {name for name in hints.COMMANDS if not name.startswith("-")} <= set(main.commands)
    for table in (hints.COMMANDS, hints.OPTIONS):
        words = [word for words in table.values() for word in words.split()]
        assert words == [word.replace("-", "").lower() for word in words]
        assert not set(words) & set(main.commands) or table is hints.OPTIONS
