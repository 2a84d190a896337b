"""Breaks a copy of the library as a line of mutants.txt says.

python3 tests/mutate.py                  looks whether each mutant finds its code exactly once
python3 tests/mutate.py NUMBER FOLDER    writes the headers to FOLDER/include with that mutant, and prints its proof

A fragment matches whatever white space, line breaks and comments stand between its words and signs.
"""
import pathlib
import re
import shutil
import sys

tests = pathlib.Path(__file__).resolve().parent
include = tests.parent / 'include'
texts = {path: path.read_text() for path in include.rglob('*.[hi][pn][pl]')}
mutants = [line for line in (tests / 'mutants.txt').read_text().splitlines() if line and line[0] != '#']


def pattern_of(fragment):
    """A regular expression. Words match as a whole."""
    words = re.findall(r'\w+|\S', fragment)
    return re.compile(r'(?:\s|//.*\n)*'.join(rf'\b{word}\b' if word[0].isalnum() else re.escape(word) for word in words))


wanted, folder = (int(sys.argv[1]), pathlib.Path(sys.argv[2])) if len(sys.argv) > 1 else (0, None)
lost = 0
for number, line in enumerate(mutants, 1):
    if wanted not in (0, number):
        continue
    proof, fragment, replacement = re.fullmatch(r'(\w+): (.+) => (.*)', line).groups()
    found = [(path, match) for path, text in texts.items() for match in pattern_of(fragment).finditer(text)]
    if len(found) != 1:
        lost += 1
        print(f'mutant {number} is found {len(found)} times, not once: {line}', *(path for path, _ in found), sep='\n  ')
    elif wanted:
        path, match = found[0]
        shutil.copytree(include, folder / 'include')
        text = texts[path][:match.start()] + replacement + texts[path][match.end():]
        (folder / path.relative_to(tests.parent)).write_text(text)
        print(proof)
if not wanted:
    print(f'{len(mutants) - lost} of {len(mutants)} mutants find their code')
sys.exit(lost > 0 or not 0 <= wanted <= len(mutants))
