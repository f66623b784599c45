#!/usr/bin/env python3
"""Makes the runs of a case, analyses them, and judges them by the case's expected values (expected.py).

usage: study.py CASE_FOLDER --programs BIN [--out DIR] [--by cases/run|suite] [further arguments of the run]

Exit code: that of a run that failed; 1 when an expected value is missed; 65 when the judgement cannot be made.
Needs nothing but Python's own library.
"""

import argparse
import json
import re
import shutil
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

sys.dont_write_bytecode = True  # a folder here is a case
from expected import CaseRun, ExpectedError, judge, read_expected, table_of  # noqa: E402


def places_of(section: str, text: str) -> list:
    """Where the heads of a table stand."""
    return list(re.finditer(rf"^\[{{1,2}}{re.escape(section)}\]{{1,2}}.*\n", text, re.MULTILINE))


def changed_case(text: str, changes: dict) -> str:
    """`text` of a case file with the keys SECTION.KEY of `changes` set. A section stands there once; a sub-table of one
    that stands there is added."""
    for name, value in changes.items():
        section, key = name.rsplit(".", 1)
        if not places_of(section, text) and "." in section and places_of(section.rsplit(".", 1)[0], text):
            text += f"\n[{section}]\n"
        heads = places_of(section, text)
        if len(heads) != 1:
            raise ExpectedError(f"[{section}] stands {len(heads)} times in case.toml, wanted once - change '{name}'")
        start = heads[0].end()
        following = re.search(r"^\[", text[start:], re.MULTILINE)
        end = start + following.start() if following else len(text)
        line = f"{key} = {json.dumps(value)}"  # strings, numbers, booleans and lists are the same in JSON and TOML
        body, found = re.subn(rf"^{re.escape(key)}\s*=.*$", lambda _: line, text[start:end], flags=re.MULTILINE)
        text = text[:start] + (body if found else f"{line}\n{body}") + text[end:]
    return text


def call(arguments: list, quiet: bool = False) -> int:
    sys.stdout.flush()
    return subprocess.run([str(a) for a in arguments], stdout=subprocess.DEVNULL if quiet else None).returncode


def case_file(folder: Path, run: CaseRun, scratch: str) -> Path:
    """The case file of `run`: where keys differ, in a copy of the folder, so that files it names are found."""
    if not run.changes:
        return folder / "case.toml"
    copy = Path(shutil.copytree(folder, Path(scratch) / folder.name)) / "case.toml"
    copy.write_text(changed_case(copy.read_text(), run.changes))
    return copy


def make_run(folder: Path, run: CaseRun, out: Path, programs: Path, further: list) -> int:
    """One run in `out`; its exit code."""
    with tempfile.TemporaryDirectory() as scratch:
        case = case_file(folder, run, scratch)
        coupled = re.search(r"^\[coupling\]", case.read_text(), re.MULTILINE)
        program = "coupler" if coupled else "qdem_solver"
        code = call([programs / program, "run", case, "--out", out, *further])
    if code != 0:
        print(f'"{folder.name}" ended with exit code {code}', file=sys.stderr)
        if (out / "run.log").exists():
            print(f"what was recorded until then is in {out}", file=sys.stderr)
    return code


def say_where(outs: list, programs: Path) -> None:
    """The page and what else there is to open."""
    print()
    for out in outs:
        print(f"Results in {out}")
        if (out / "qdem.xdmf").exists():
            files = [out / name for name in ("qdem.xdmf", "fem.xdmf") if (out / name).exists()]
            print("  paraview " + " ".join(f'"{file}"' for file in files) + '   (ParaView 5.11: reader "Xdmf3 Reader S")')
        if (out / "coupling.h5").exists():
            print(f'  h5dump -n "{out}/coupling.h5"   what was recorded at the interface, window by window')
        if (out / "summary.json").exists():
            print(f"  {out}/summary.json   the figures of the run")
    page = subprocess.run([programs / "coupler", "report", *outs], capture_output=True, text=True)
    print("  " + (page.stdout + page.stderr).strip())


def study(options: argparse.Namespace, out: Path) -> int:
    folder = options.case.resolve()
    runs, ratios = read_expected(folder)
    runs = [run for run in runs if options.by in run.by]
    if not runs:
        raise ExpectedError(f"no run is made by '{options.by}' - {folder / 'expected.toml'}")
    for run in runs:
        if run.title:
            print(f"{folder.name}: {run.title}")
        code = make_run(folder, run, out / run.name, options.programs, options.further)
        if code == 0 and (run.analyze or any("summary" not in e.where for e in run.expected + ratios)):
            code = call([options.programs / "coupler", "analyze", out / run.name, *run.analyze], quiet=True)
        if code != 0:
            return code
    if options.by == "cases/run":
        say_where([out / run.name for run in runs], options.programs)
    judgements = judge(runs, ratios, out)
    if judgements:
        found = f"\n{folder.name}: expected values\n{table_of(judgements)}"
        print(found)
        (out / "findings.txt").write_text(found + "\n")
    return 0 if all(j.holds for j in judgements) else 1


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter, allow_abbrev=False
    )
    parser.add_argument("case", type=Path, help="folder of the case")
    parser.add_argument("--programs", type=Path, required=True, help="folder of coupler and qdem_solver")
    parser.add_argument("--out", type=Path, help="folder for results; without it they are thrown away")
    parser.add_argument("--by", default="cases/run", choices=["cases/run", "suite"], help="whose runs to make")
    options, options.further = parser.parse_known_args()
    signal.signal(signal.SIGINT, lambda *_: None)  # the run ends in order by itself, and is waited for
    try:
        with tempfile.TemporaryDirectory() as scratch:
            return study(options, (options.out or Path(scratch)).resolve())
    except (ExpectedError, OSError, KeyError) as error:
        print(f"study.py: {error}", file=sys.stderr)
        return 65


if __name__ == "__main__":
    sys.exit(main())
