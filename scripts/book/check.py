"""Checks that the README and the pages of the book say what the program does.

- Shell: every command `hangpose` of a block ```sh runs, and a block ```text after `<!-- output -->` is what it prints;
  a line `...` stands for any lines. `<!-- exit 3 -->` before the block is the status of its last command. A block after
  `<!-- not run: reason -->` does not run; its subcommands and options must exist. Every `make` target must exist.
- Files: a block after `<!-- file: name -->` is written to this file, for the commands of the same page.
- Python: every block runs; those that import hangpose run with build/python, which scripts/python.sh makes.
- C and C++: a block that is not an include must be a part of a file in examples-c/, or several, with `// ...` between.
- JSON: the page on it names every field of a prediction.
- Parameters: the columns of tables `| Parameter |` are the ranges and defaults of the program.
- Figures: `<!-- cites file: rows -->` names rows of a table that a command prints; the file must still have them.
- Names: "`name` in [file](file)" is true.
- Links between files, and to headings, lead somewhere.
"""

import json
import os
import re
import shlex
import subprocess
import sys
import tempfile
import unicodedata
from functools import cache
from pathlib import Path

from markdown_it import MarkdownIt

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = Path(os.environ["HANGPOSE"]).resolve()
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md", *sorted((ROOT / "docs").rglob("*.md"))]
RUN = [ROOT / "README.md", *sorted((ROOT / "docs" / "book").glob("*.md"))]
PYTHON = ROOT / "build" / "python" / "bin" / "python"

problems = []
counts = {"run": 0, "only read": 0, "Python": 0, "C and C++": 0, "parameters": 0, "cited rows": 0, "names in files": 0, "links": 0}


def problem(page, line, text):
    problems.append(f"{page.relative_to(ROOT)}:{line}: {text}")


def blocks(page):
    """The code blocks of a page: language, text, first line, and the comments directly before it."""
    comments = []
    for token in MarkdownIt().enable("table").parse(page.read_text()):
        if token.type == "html_block":
            comments += re.findall(r"<!--\s*(.*?)\s*-->", token.content, re.DOTALL)
        elif token.type == "fence":
            yield token.info.split(",")[0].strip(), token.content, token.map[0] + 1, comments
            comments = []
        elif token.level == 0:
            comments = []


def commands(text):
    """The command lines of a shell block, as lists of words."""
    for line in text.replace("\\\n", " ").splitlines():
        words = shlex.split(line, comments=True)
        if words:
            yield words


@cache
def options(subcommand):
    run = subprocess.run([PROGRAM, *subcommand, "--help"], capture_output=True, text=True, check=False)
    return None if run.returncode else set(re.findall(r"(?<![\w-])--?[a-z][\w-]*", run.stdout))


@cache
def targets():
    return set(re.findall(r"^([\w-]+):", (ROOT / "Makefile").read_text(), re.MULTILINE))


def check_words(page, line, words):
    """That the subcommand and the options of a command exist."""
    if words[0] == "make":
        for word in words[1:]:
            if re.fullmatch(r"[a-z][\w-]*", word) and word not in targets() and "-C" not in words:
                problem(page, line, f"make has no target {word}")
    elif words[0] == "hangpose":
        subcommand = tuple(word for word in words[1:2] if not word.startswith("-"))
        known = options(subcommand)
        if known is None:
            problem(page, line, f"hangpose has no subcommand {' '.join(subcommand)}")
            return
        for word in words[1:]:
            option = word.split("=")[0]
            if re.fullmatch(r"--?[a-z][\w-]*", option) and option not in known:
                problem(page, line, f"hangpose {' '.join(subcommand)} has no option {option}")


def matches(expected, printed):
    parts = [re.escape(part.strip("\n")) for part in re.split(r"^\.\.\.$", expected.strip("\n"), flags=re.MULTILINE)]
    return (
        re.fullmatch(r"(?:.*\n)*?".join(part + r"\n?" if part else "" for part in parts), printed.strip("\n") + "\n")
        is not None
    )


def check_shell(page, folder):
    printed = None
    for language, text, line, comments in blocks(page):
        name = next((comment[6:] for comment in comments if comment.startswith("file: ")), None)
        if name:
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_text(text)
        if language == "text" and "output" in comments:
            if printed is None:
                problem(page, line, "this output follows no command that was run")
            elif not matches(text, printed):
                problem(page, line, f"the command prints something else:\n{printed}")
        if language != "sh":
            continue
        is_run = not any(comment.startswith("not run: ") for comment in comments)
        status = next((int(comment[5:]) for comment in comments if comment.startswith("exit ")), 0)
        printed, last = "", 0
        for words in commands(text):
            check_words(page, line, words)
            if words[0] != "hangpose":
                continue
            counts["run" if is_run else "only read"] += 1
            if is_run:
                run = subprocess.run(
                    [PROGRAM, *words[1:]],
                    cwd=folder,
                    stdout=subprocess.PIPE,
                    stderr=subprocess.STDOUT,
                    text=True,
                    check=False,
                )
                printed, last = printed + run.stdout, run.returncode
        if is_run and last != status:
            problem(page, line, f"the last command ends with status {last}, not {status}:\n{printed}")
        printed = printed if is_run else None


def check_python(page, folder):
    for language, text, line, comments in blocks(page):
        if language != "python" or any(comment.startswith("not run: ") for comment in comments):
            continue
        counts["Python"] += 1
        interpreter = PYTHON if "import hangpose" in text else sys.executable
        if not Path(interpreter).exists():
            problem(page, line, f"{interpreter} is missing; run scripts/python.sh")
        else:
            run = subprocess.run([interpreter, "-c", text], cwd=folder, capture_output=True, text=True, check=False)
            if run.returncode:
                problem(page, line, f"this Python fails:\n{run.stderr}")


def check_excerpts(page):
    shown = [path.read_text() for path in sorted((ROOT / "examples-c").glob("*.*")) if path.suffix in {".c", ".cpp"}]
    shown += [path.read_text() for path in sorted((ROOT / "ros2").rglob("*.cpp"))]
    shown = [re.sub(r"^ +", "", text, flags=re.MULTILINE) for text in shown]
    for language, text, line, _ in blocks(page):
        if language in {"c", "cpp"} and "{{#include" not in text:
            counts["C and C++"] += 1
            parts = re.sub(r"^ +", "", text, flags=re.MULTILINE).split("// ...\n")
            if not any(re.search(".*".join(map(re.escape, parts)), file, re.DOTALL) for file in shown):
                problem(page, line, "no file in examples-c/ has these lines")


@cache
def defaults(profile):
    files = ("--object", "samples/mug.obj", "--supporter", "samples/hook.ply", "--top", "1")
    run = subprocess.run(
        [PROGRAM, "predict", *files, "--profile", profile, "--json", "-"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    )
    return json.loads(run.stdout)["params"]


def range_of(parameter):
    """The range that the program names when a value is out of it, or None."""
    with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
        value = 10**15 if isinstance(defaults("paper")[parameter], int) else "1e30"
        file.write(f"{parameter} = {value}")
        file.flush()
        files = ("--object", "samples/mug.obj", "--supporter", "samples/hook.ply")
        run = subprocess.run(
            [PROGRAM, "predict", *files, "--params", file.name], cwd=ROOT, capture_output=True, text=True, check=False
        )
        found = re.search(r"outside its range, (\S+) to (\S+)", run.stderr)
        return tuple(map(float, found.groups())) if found else None


def same(shown, value):
    shown = shown.strip("`")
    if isinstance(value, bool | str):
        return shown == str(value).lower()
    if isinstance(value, list):
        return [float(x) for x in shown.strip("[]").split(",")] == value
    return abs(float(shown.replace(" ", "")) - value) <= 1e-6 * abs(value)


def check_parameters(page):
    """Checks the tables of parameters of a page, and gives the names in them."""
    names = set()
    is_table = False
    for line, row in enumerate(page.read_text().splitlines(), 1):
        cells = [cell.strip() for cell in row.strip().strip("|").split("|")]
        if row.startswith("| Parameter |"):
            is_table = True
        elif not row.startswith("|"):
            is_table = False
        elif is_table and not row.startswith("|-"):
            parameter, _, _, shown, paper, default = (cell.strip("`") for cell in cells[:6])
            names.add(parameter)
            counts["parameters"] += 1
            if parameter not in defaults("paper"):
                problem(page, line, f"there is no parameter {parameter}")
                continue
            for profile, value in (("paper", paper), ("default", default)):
                if not same(value, defaults(profile)[parameter]):
                    problem(
                        page,
                        line,
                        f"{parameter} is {defaults(profile)[parameter]} in the profile {profile}, not {value}",
                    )
            limits = re.fullmatch(r"(\S+) to (.+)", shown)
            limits = limits and tuple(float(limit.replace(" ", "")) for limit in limits.groups())
            if limits != range_of(parameter):
                problem(page, line, f"the range of {parameter} is {range_of(parameter)}, not {limits}")
    return names


def keys_of(value):
    """The names of all fields of a JSON value."""
    if isinstance(value, dict):
        for name, field in value.items():
            yield name
            if name not in {"params", "counts"}:
                yield from keys_of(field)
    elif isinstance(value, list):
        for element in value:
            yield from keys_of(element)


def check_json():
    """That the page on the JSON names every field."""
    page = ROOT / "docs" / "book" / "json.md"
    files = ("--object", "samples/mug.obj", "--supporter", "samples/hook.ply", "--top", "1", "--plan")
    run = subprocess.run(
        [PROGRAM, "predict", *files, "--json", "-"], cwd=ROOT, capture_output=True, text=True, check=True
    )
    text = page.read_text()
    for key in sorted(set(keys_of(json.loads(run.stdout)))):
        if f'"{key}"' not in text:
            problem(page, 1, f"the JSON has a field {key}")


def check_cited(page):
    """That the rows from which a page has its figures are still there."""
    for cited in re.finditer(r"<!-- cites (\S+):\n(.*?)-->", page.read_text(), re.DOTALL):
        file, rows = cited.groups()
        there = (ROOT / file).read_text()
        for row in rows.strip().splitlines():
            counts["cited rows"] += 1
            if row.strip() not in there:
                line = page.read_text()[: cited.start()].count("\n") + 1
                problem(page, line, f"{file} has no longer this row, so correct the figures near here: {row}")


def slug(heading):
    """The anchor that GitHub and mdBook give to a heading."""
    kept = "".join(c for c in heading.lower() if c in " -_" or unicodedata.category(c)[0] in "LN")
    return kept.replace(" ", "-")


@cache
def anchors(page):
    tokens = MarkdownIt().parse(page.read_text())
    headings = [tokens[i + 1] for i, token in enumerate(tokens) if token.type == "heading_open"]
    return {slug("".join(child.content for child in heading.children)) for heading in headings}


def check_links(page):
    for token in MarkdownIt().enable("table").parse(page.read_text()):
        for child in token.children or []:
            target = child.attrs.get("href") or child.attrs.get("src")
            if not target or re.match(r"[a-z]+:", str(target)):
                continue
            counts["links"] += 1
            path, _, anchor = str(target).partition("#")
            file = (page.parent / path).resolve() if path else page
            if not file.exists():
                problem(page, token.map[0] + 1, f"the link {target} leads nowhere")
            elif anchor and file.suffix == ".md" and anchor not in anchors(file):
                problem(page, token.map[0] + 1, f"{path} has no heading #{anchor}")


def check_named(page):
    """That a file has the function or constant that a page says is in it."""
    for line, text in enumerate(page.read_text().splitlines(), 1):
        for name, path in re.findall(r"`([\w:]+)` in \[[^\]]+\]\(([^)]+\.rs)\)", text):
            counts["names in files"] += 1
            if not re.search(rf"\b{name.split('::')[-1]}\b", (page.parent / path).read_text()):
                problem(page, line, f"{path} has no {name}")


def main():
    named = set()
    for page in RUN:
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "samples").symlink_to(ROOT / "samples")
            check_shell(page, Path(folder))
            check_python(page, Path(folder))
        check_excerpts(page)
        named |= check_parameters(page)
        check_cited(page)
        check_named(page)
    for missing in sorted(set(defaults("paper")) - named):
        problems.append(f"docs/book: no table of parameters has {missing}")
    check_json()
    for page in PAGES:
        check_links(page)
    print("book:", ", ".join(f"{count} {what}" for what, count in counts.items()))
    if problems:
        sys.exit("\n".join(problems))


if __name__ == "__main__":
    main()
