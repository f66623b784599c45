"""case_schema.py COUPLER ROOT: `coupler schema` is a JSON Schema that every shipped case keeps, that refuses each key of
each case when it is misspelt, and that lets a material of one's own be used. Exit code 77 where python3-jsonschema is
missing."""
import copy
import json
import pathlib
import subprocess
import sys
import tomllib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "support"))
import case_lines  # noqa: E402

try:
    from jsonschema import Draft202012Validator
except ImportError:
    print("NOT RUN: there is no python3-jsonschema")
    sys.exit(77)

coupler, root = sys.argv[1], pathlib.Path(sys.argv[2])
schema = json.loads(subprocess.run([coupler, "schema"], check=True, capture_output=True, text=True).stdout)
Draft202012Validator.check_schema(schema)
validator = Draft202012Validator(schema)
problems = []


def problem_of(case):
    for error in validator.iter_errors(case):
        return f"{'.'.join(map(str, error.absolute_path))}: {error.message}"
    return None


n_cases = n_keys = 0
for path in sorted(root.glob("cases/*/case.toml")):
    text = path.read_text()
    n_cases += 1
    if problem := problem_of(tomllib.loads(text)):
        problems.append(f"{path}: {problem}")
    for key in case_lines.keys_of(text, schema):
        n_keys += 1
        line = text.splitlines()[key.line]
        misspelt = tomllib.loads(case_lines.with_line(text, key.line, "q" + line))
        if problem_of(misspelt) is None:
            problems.append(f"{path}: {key.full_name} may be misspelt")
        if not key.schema or not key.schema.get("type"):
            problems.append(f"{path}: nothing is known of {key.full_name}")

# A few words of its own: choices, ranges, defaults, what is required, and only where it is.
coupling = schema["properties"]["coupling"]
wheel, load = case_lines.at(schema, "wheel"), case_lines.at(schema, "qdem.run.load")
expected = {
    "choices": (coupling["properties"]["scheme"]["enum"], ["R1", "R2", "E0", "E1", "E2", "implicit", "one_way", "GC", "PH"]),
    "a default": (coupling["properties"]["iteration"]["properties"]["reused_windows"]["default"], 8),
    "required": (coupling["required"], ["duration_s"]),
    "an open range": (wheel["properties"]["radius_m"], {"type": "number", "exclusiveMinimum": 0.0}),
    "a sub-table of the wheel": (wheel["properties"]["irregularity"].get("required"), None),
    "keys of every kind of load": ({"time_s", "peak_n", "cycles", "mass_kg", "drop_height_m"} <= set(load["properties"]), True),
    "a load needs its kind only": (load.get("required"), ["kind"]),
    "names of the case's own": ("enum" in case_lines.at(schema, "qdem.subgrade")["properties"]["material"], False),
}
for what, (found, wanted) in expected.items():
    if found != wanted:
        problems.append(f"{what}: {found} instead of {wanted}")
case = tomllib.loads((root / "cases/split_oscillator/case.toml").read_text())
for what, change in {
    "a number as a text": lambda c: c["coupling"].update(window_s="short"),
    "a value out of its range": lambda c: c["rail_seat"][0].update(cells=[0, 1]),
    "a list too short": lambda c: c["rail_seat"][0].update(origin_m=[0.0]),
    "an unknown scheme": lambda c: c["coupling"].update(scheme="R7"),
    "a missing key": lambda c: c["coupling"].pop("duration_s"),
    "an unknown section": lambda c: c.update(rail={}),
}.items():
    changed = copy.deepcopy(case)
    change(changed)
    if problem_of(changed) is None:
        problems.append(f"{what} is accepted")

print("\n".join(problems))
print(f"{n_cases} cases, {n_keys} keys, {len(problems)} problems")
sys.exit(1 if problems or n_cases < 4 or n_keys < 100 else 0)
