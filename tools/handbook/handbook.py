#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes the pages of the handbook: runs the commands of its chapters, and puts in what they print and draw.

    handbook.py DELF WORK [FOLDER] [--films]      FOLDER has the chapters; this one, if not given

WORK/pages then mirrors the repository: the chapters, the READMEs that they lie beside, the headers of the library and the
scenes. In a chapter, a block marked `sh` is run by bash in WORK/run/CHAPTER, and must end with exit code 0; a block with a
title is a file there. A comment after a block says what of its output is shown:

    <!-- output -->                all
    <!-- output: PATTERN -->       lines in which the regular expression PATTERN is found
    <!-- insert -->                all, as Markdown: a table, or mathematics
    <!-- keys -->                  needs no block: all keys of all commands, as tables
    <!-- film: DIR -->             needs no block: the film of the run in DIR, where the program makes one; the first one
                                   only, without --films

A figure must be made by a command of its chapter, and a decimal number in its prose stand in a block or be printed. The
commands of the READMEs run too, those that take minutes at a smaller size.
"""

import argparse
import contextlib
import os
import pathlib
import re
import resource
import shutil
import subprocess
import sys

here = pathlib.Path(__file__).resolve().parent
root = here.parent.parent
rooms = ("lattice", "jets", "schemes")
smaller = {"workprecision": "--workprecision.budget=2", "stability": "--stability.corners=none --stability.map=off "
           "--stability.steps=100 --stability.schemes=vertex,triangle-vertex"}  # what makes long commands short
fence = re.compile(r"^```(\w+)?(?:.*title=\"([^\"]+)\")?")


class Wrong(Exception):
    pass


class Program:
    """The program, as commands of a chapter find it."""

    def __init__(self, delf, work, films):
        self.work, self.films, self.commands = work, films, 0
        for name in ("bin", "build/release"):  # chapters have the program on the path, READMEs where it is built
            (work / name).mkdir(parents=True)
            (work / name / "delf").symlink_to(delf)
        for name in ("tools", "tests"):
            (work / name).symlink_to(root / name)
        self.environment = {**os.environ, "PATH": f"{work / 'bin'}:/usr/bin:{os.environ['PATH']}", "DELF_SOURCE": str(root)}

    def run(self, script, folder, place):
        ran = subprocess.run(["bash", "-e", "-o", "pipefail", "-c", script], cwd=folder, env=self.environment,
                             capture_output=True, text=True)
        if ran.returncode:
            raise Wrong(f"{place}: exit code {ran.returncode}: {(ran.stderr or ran.stdout).strip()}")
        self.commands += len(re.findall(r"^[a-z]", script.replace("\\\n", " "), re.MULTILINE))
        return ran.stdout

    def help(self, *words):
        return subprocess.run(["delf", "help", *words], env=self.environment, capture_output=True, text=True, check=True).stdout

    def knows(self):
        """The commands of the program, in its own order."""
        return list(dict.fromkeys(re.findall(r"^  delf ([a-z]+)", self.help(), re.MULTILINE)))

    def film(self, run, folder, place):
        """The film of a run, if the program makes films: the first one only, unless all are asked for."""
        if not self.films or "film" not in self.knows():
            return []
        self.films -= 1
        self.run(f"delf film {run}", folder, place)
        made = next((folder / run).glob("film.*"))
        source = f"run/{folder.name}/{run}/{made.name}"
        if made.suffix == ".gif":
            return ["", f"![The same, as a film]({source})"]
        return ["", f'<video controls muted loop preload="none" poster="run/{folder.name}/{run}/figures/film.png" src="{source}">'
                    "</video>"]

    def keys(self):
        """Tables of all keys by section, as `delf help COMMAND` has them."""
        sections = {}
        for command in self.knows():
            for name, purpose, text in re.findall(r"^\[(\w+)\] *(.*)\n((?:  .*\n|\n)*)", self.help(command), re.MULTILINE):
                text = re.sub(r"\n {6,}", " ", text)
                keys = re.findall(r"^  (?:([a-z]+\.\S+) +)?(.*)", text, re.MULTILINE)
                sections.setdefault(name, [
                    "", f"### [{name}]", "", purpose or f"Of `delf {command}`.", "", "| key | meaning |", "|---|---|",
                    *(f"| `{key}` | {plain(words)} |" if key else f"| | *{plain(words.rstrip(':'))}* |" for key, words in keys)])
        return [line for section in sections.values() for line in section] + [""]


def plain(text):
    """Text that means itself in Markdown; what stands between backticks is code already."""
    parts = re.split(r"(`[^`]*`)", text)
    escaped = (re.sub(r"([\\*_\[\]|#`])", r"\\\1", part).replace("&", "&amp;").replace("<", "&lt;") for part in parts[::2])
    return "".join(a + b for a, b in zip(escaped, parts[1::2] + [""]))


def chapter(source, program):
    """The page of a chapter, its commands run."""
    name = source.stem
    folder = program.work / "run" / name
    folder.mkdir(parents=True)
    page, prose, printed, body, output = [], [], [], None, ""
    for number, line in enumerate(source.read_text().splitlines(), 1):
        place = f"{source.name}:{number}"
        if body is not None:
            if line == "```":
                text = "\n".join(body) + "\n"
                printed.append(text)
                if title:
                    (folder / title).write_text(text)
                elif language == "sh":
                    output = program.run(text, folder, begun)
                    printed.append(output)
                body = None
            else:
                body.append(line)
            page.append(line)
        elif opened := fence.match(line):
            language, title = opened.groups()
            begun, body = place, []
            page.append(line)
        elif directive := re.match(r"<!-- (output|insert|keys|film)(?:: (.*))? -->$", line):
            what, argument = directive.groups()
            if what == "keys":
                page += program.keys()
            elif what == "film":
                page += program.film(argument, folder, place)
            else:
                shown = [one for one in output.splitlines() if not argument or re.search(argument, one)]
                if not shown:
                    raise Wrong(f"{place}: the command prints no such line")
                blank = lambda one: ["", one] if one == r"\[" else [one]  # mathematics is a paragraph of its own
                page += ["", *(part for one in shown for part in blank(one)), ""] if what == "insert" else [
                    "```text", *shown, "```"]
        else:
            page.append(line)
            if not line.startswith(("#", "|")):
                prose.append((place, line))
    for place, line in prose:
        for image in re.findall(r"!\[[^\]]*\]\(([^)]+)\)", line):
            if not image.startswith("../") and not (folder / image).is_file():
                raise Wrong(f"{place}: no command makes the figure {image}")
        words = re.sub(r"`[^`]*`|\]\([^)]*\)|\(\d+\.\d+\)|§\d+\.\d+|\$[^$]*\$", "", line)
        for decimal in re.findall(r"\d+\.\d+(?:e-?\d+)?|\d+e-\d+", words):
            if not any(re.search(rf"(?<![\d.]){re.escape(decimal)}", text) for text in printed):
                raise Wrong(f"{place}: no command prints {decimal}")
    return re.sub(r"(!\[[^\]]*\]\()(?!\.\./)", rf"\g<1>run/{name}/", "\n".join(page)) + "\n"


def readme(source, program):
    """Runs the commands of a README. `delf verify` may end with exit code 1, for READMEs show checks that fail."""
    text = source.read_text()
    for title, body in re.findall(r"^```\w+ title=\"([^\"]+)\"\n(.*?)^```", text, re.MULTILINE | re.DOTALL):
        (program.work / title).write_text(body)
    for line in re.finditer(r"^    ((?:build/release/delf |python3 tools/examples)(?:.*\\\n)*.*)", text, re.MULTILINE):
        place = f"{source.relative_to(root)}:{text[: line.start()].count(chr(10)) + 1}"
        command = re.sub(r"\s+#.*", "", line[1]).replace("\\\n", " ").replace("/tmp/", "tmp/")
        word = command.split()[1]
        for key in smaller.get(word, "").split():
            command = re.sub(rf"\s{key.split('=')[0]}=\S+|$", "", command, count=1) + " " + key
        program.run(command + (" || [ $? = 1 ]" if word == "verify" else ""), program.work, place)


def prose_and_code(source):
    """A header as a page reads it: its comments at the margin as text, what lies between them as code."""
    parts, comment = [], None
    for line in source.read_text().splitlines():
        is_comment = line.startswith("///") and not line.startswith("///<")
        if is_comment != comment:
            parts.append([])
            comment = is_comment
        parts[-1].append(line)
    page = []
    for part in parts:
        if part[0].startswith("///"):
            words = [line[3:].removeprefix(" ") for line in part]
            page += ["", *(line if line.startswith("    ") else plain(line) for line in words), ""]
        else:
            code = "\n".join(line for line in part if not re.match(r"// SPDX|#pragma once", line)).strip("\n")
            page += ["```cpp", code, "```"] if code else []
    return page


def files_page(folder):
    """The headers of a folder, or its scenes, one after the other."""
    path = folder.relative_to(root)
    page = [f"# {path}", ""]
    for source in sorted([*folder.glob("*.hpp"), *folder.glob("*.ini"), *folder.glob("*.py")]):
        body = prose_and_code(source) if source.suffix == ".hpp" else [
            f"```{source.suffix[1:]}", source.read_text().strip("\n"), "```"]
        page += [f"## {source.name if source.suffix != '.ini' else source.stem}", "", *body, ""]
    return "\n".join(page)


class Site:
    """The pages that are made, each at its place in the repository, and what they link to."""

    def __init__(self, pages):
        self.pages, self.waiting, self.done = pages, [], set()

    def add(self, path, text):
        self.done.add(path)
        lines, code = [], False
        for line in text.splitlines():
            code ^= line.startswith("```")
            is_prose = not code and not line.startswith("    ")
            lines.append(re.sub(r"(\]\()([^)\s#]+)(#[^)]*)?\)", lambda m: self.link(path, m), line) if is_prose else line)
        (self.pages / path).parent.mkdir(parents=True, exist_ok=True)
        (self.pages / path).write_text("\n".join(lines) + "\n")

    def link(self, path, match):
        """A link to a folder is to its README, or else to a page of its files; other files come along."""
        target = match[2]
        if re.match(r"\w+:|run/", target):
            return match[0]
        to = pathlib.Path(os.path.normpath(path.parent / target))
        if (root / to).is_dir():
            to = to / "README.md" if (root / to / "README.md").is_file() else to / "files.md"
        elif not (root / to).is_file() and to.name != "files.md" and to not in self.done:
            raise Wrong(f"{path}: {target}: no such file")
        self.waiting.append(to)
        return f"{match[1]}{os.path.relpath(to, path.parent)}{match[3] or ''})"

    def follow(self):
        while self.waiting:
            path = self.waiting.pop()
            if path in self.done or (self.pages / path).exists():
                continue
            if path.name == "files.md":
                self.add(path, files_page(root / path.parent))
            elif path.suffix == ".md":
                self.add(path, (root / path).read_text())
            else:
                (self.pages / path).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(root / path, self.pages / path)


def library_page():
    """Every folder of the library that has headers, with the number of them."""
    page = ["| folder | headers |", "|---|---|"]
    for room in rooms:
        for folder in sorted({header.parent for header in (root / room).rglob("*.hpp")}):
            path = folder.relative_to(root)
            names = ", ".join(f"`{header.stem}`" for header in sorted(folder.glob("*.hpp")))
            page.append(f"| [{path}](../../{path}/files.md) | {names} |")
    return "\n".join(page)


@contextlib.contextmanager
def processor_time(name):
    spent = lambda: resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    before = spent()
    yield
    print(f"{name}: {spent() - before:.1f} s of a processor", flush=True)


def main():
    parser = argparse.ArgumentParser(prog="handbook.py", description=__doc__.splitlines()[0])
    for name in ("delf", "work"):
        parser.add_argument(name, type=pathlib.Path)
    parser.add_argument("chapters", type=pathlib.Path, nargs="?", default=here)
    parser.add_argument("--films", action="store_const", const=1000, default=1)
    given = parser.parse_args()
    delf, work, chapters = given.delf.resolve(), given.work.resolve(), given.chapters.resolve()
    if not delf.exists():
        raise Wrong(f"{delf}: no such program; build it, or name another")
    if work.exists() and any(work.iterdir()) and not (work / "bin/delf").is_symlink():
        raise Wrong(f"{work}: is no folder of an earlier handbook, and would be emptied; name another")
    shutil.rmtree(work, ignore_errors=True)
    program, site = Program(delf, work, given.films), Site(work / "pages")
    sources = sorted(chapters.glob("*.md"))
    site.done.update(pathlib.Path("tools/handbook") / source.name for source in sources)
    for source in sources:
        with processor_time(source.name):
            page = chapter(source, program).replace("<!-- library -->", library_page())
        site.add(pathlib.Path("tools/handbook") / source.name, page)
    if chapters == here:
        readmes = [path for room in (*rooms, "tools", "tests") for path in sorted((root / room).rglob("README.md"))
                   if path.parent != here and "node_modules" not in path.parts]
        for source in [root / "README.md", *readmes]:
            site.waiting.append(source.relative_to(root))
            with processor_time(source.relative_to(root)):
                readme(source, program)
        site.waiting.append(pathlib.Path("CHANGELOG.md"))
    site.follow()
    for made in (work / "run").rglob("*"):
        if made.suffix in (".svg", ".mp4", ".gif") or made.name == "film.png":
            to = work / "pages/tools/handbook/run" / made.relative_to(work / "run")
            to.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(made, to)
    for made in work.iterdir():  # rows of runs, 200 MB
        if made.name not in ("bin", "pages"):
            shutil.rmtree(made) if made.is_dir() and not made.is_symlink() else made.unlink()
    print(f"{program.commands} commands ran, {resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime:.0f} s of a processor")


try:
    main()
except Wrong as wrong:
    sys.exit(f"handbook: {wrong}")
