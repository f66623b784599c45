"""case_mutations.py BIN_FOLDER ROOT: every key of every shipped case misspelt, of another type, out of its range, not a
number, missing, duplicated. What can be wrong with a key comes from `coupler schema`. The program that reads the section must
refuse each with the exit code of a bad case, one line, the place of the key in the file, and the name that was meant.

Most go to read_case_files, which has the programs' readers without their start; every 25th to the program itself."""
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "support"))
import case_lines  # noqa: E402

BAD_CASE = 78

bin_folder, root = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
os.environ["GOMP_SPINCOUNT"] = "0"  # qdem_solver starts itself once more without
schema = json.loads(subprocess.run([bin_folder / "coupler", "schema"], check=True, capture_output=True, text=True).stdout)


THROUGH_THE_PROGRAM = 25
reader = subprocess.Popen([bin_folder.parent / "test_bin/read_case_files"], stdin=subprocess.PIPE,
                          stdout=subprocess.PIPE, text=True)


# A misspelling that first breaks what the key belongs to: the complaint is about that, and names this.
TOLD_BY_ANOTHER_KEY = {
    "bed.sieve_sizes_m": "sieve",
    "bed.sieve_passing_percent": "sieve",
    "coupling.initialise.max_windows": "max_windows",
    "qdem.sensor_interval_s": "sensor_interval_s",
    "qdem.run.load.drop_height_m": "drop_height_m",
    "qdem.run.load.half_lengths_m": "half_lengths_m",
    "qdem.contact.normal_stiffness_n_per_m": "normal_stiffness_n_per_m",
    "qdem.contact.damping_ratio": "damping_ratio",
}


def command(top):
    if top == "rail_seat":
        return [bin_folder / "fem_solver" if "[coupling]" in text else bin_folder / "qdem_solver", "check", "--case"]
    if top == "coupling":
        return [bin_folder / "coupler", "check"]
    program = {"bed": "qdem_solver", "qdem": "qdem_solver", "oscillator": "oscillator_participant"}.get(top, "fem_solver")
    return [bin_folder / program, "check", "--case"]


def toml(value):
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    if isinstance(value, float) and not math.isfinite(value):
        return "nan" if math.isnan(value) else "inf"
    return json.dumps(value)


def out_of_range(schema):
    """Values just outside of what a number may be."""
    step = 1 if schema["type"] == "integer" else 1e-3
    if "minimum" in schema:
        yield "below", schema["minimum"] - step
    if "exclusiveMinimum" in schema:
        yield "at an excluded end", schema["exclusiveMinimum"]
    if "maximum" in schema:
        yield "above", schema["maximum"] + step


def wrong_values(schema):
    kind = schema["type"]
    if kind == "array":
        yield "no array", 1
        n = schema.get("minItems", 2)
        if "minItems" in schema:
            yield "one too many", [1] * (n + 1)
        for what, value in wrong_values(schema["items"]):
            yield "an element " + what, [value] * n
    elif kind == "string":
        yield "a number", 1.5
        if "enum" in schema:
            yield "no choice", "no_such_choice"
    elif kind == "boolean":
        yield "a number", 1
    else:
        yield "a text", "1.0"
        yield "a boolean", True
        yield from out_of_range(schema)
        if kind == "number":
            yield "not a number", math.nan
            yield "infinite", math.inf
        else:
            yield "a fraction", 1.5


def mutations(key, lines):
    """(what, changed line or lines, line of the complaint or None, words of the complaint)"""
    name, line = key.name, lines[key.line]
    short = name[:2] + name[3:] if len(name) > 2 else name[0]
    misspelt = line.replace(name, short, 1)
    if key.full_name in TOLD_BY_ANOTHER_KEY:
        yield "misspelt", misspelt, None, [TOLD_BY_ANOTHER_KEY[key.full_name]]
    else:
        yield "misspelt", misspelt, key.line, [short, "did you mean '"]
    yield "duplicated", [line, line], key.line + 1, [name]
    if key.required:
        yield "missing", None, None, ["missing", name]
    for what, value in wrong_values(key.schema):
        yield what, f"{name} = {toml(value)}", key.line, [name]


def refusal(section, path, through_the_program):
    """Exit code and message."""
    top = section.split(".")[0]
    if through_the_program or top == "oscillator":
        result = subprocess.run([*command(top), path], capture_output=True, text=True, timeout=60)
        return result.returncode, result.stderr.strip()
    reader.stdin.write(f"{top} {path}\n")
    reader.stdin.flush()
    code, _, text = reader.stdout.readline().strip().partition(" ")
    return int(code), text


def complaint_about(code, text, path, line, words):
    """What is wrong with how a bad case was refused; None if nothing is."""
    if code != BAD_CASE:
        return f"exit code {code}: {text[:200]}"
    if len(text.splitlines()) != 1:
        return f"not one line: {text[:400]}"
    place = f"{path}:" if line is None else f"{path}:{line + 1}:"
    missing = [word for word in [place, *words] if word not in text]
    return f"{missing} not in: {text}" if missing else None


problems, done = [], set()
with tempfile.TemporaryDirectory() as folder:
    for case in sorted(root.glob("cases/*/case.toml")):
        text = case.read_text()
        for relative in case.parent.iterdir():
            if relative.is_dir() and not (pathlib.Path(folder) / relative.name).exists():
                (pathlib.Path(folder) / relative.name).symlink_to(relative)
        path = pathlib.Path(folder) / "case.toml"
        for key in case_lines.keys_of(text, schema):
            for what, lines, line, words in mutations(key, text.splitlines()):
                if (key.full_name, what) in done:
                    continue
                done.add((key.full_name, what))
                path.write_text(case_lines.with_line(text, key.line, lines))
                code, answer = refusal(key.section, path, len(done) % THROUGH_THE_PROGRAM == 0)
                if problem := complaint_about(code, answer, path, line, words):
                    problems.append(f"{case.parent.name}, {key.full_name} {what}: {problem}")

reader.stdin.close()
reader.wait()
print("\n".join(problems))
print(f"{len(done)} bad cases, {len(problems)} problems")
sys.exit(1 if problems or len(done) < 500 else 0)
