"""Expected values of a case: `expected.toml` in its folder, and how a run is judged by it.

    [[run]]                      # one or more; a case without the file is one run with nothing expected
    name = "bond"                # folder below the case's output; may be left out where there is one run
    title = "..."                # for the table
    changes = { "qdem.particle_interaction" = "bond" }     # keys of case.toml that differ, SECTION.KEY; also of a
                                 # [[SECTION]] that stands there once; a sub-table that is not there is added
    by = ["cases/run", "suite"]  # who makes this run; default: cases/run alone
    analyze = ["--bins", "4"]    # further arguments of "coupler analyze"

    [[run.expected]]
    quantity = "first bending mode [Hz]"
    table = "modes_sensor_end"   # CSV file of the analysis, with `column` and one of
    column = "frequency"         #   row = N, nearest = VALUE, take = "largest" | "smallest" | "first" | "last" | "mean" |
                                 #   "smallest_share" (smallest over largest),
                                 #   at_largest = COLUMN (the row in which that column is largest); between = [LOW, HIGH] of
                                 #   the first column bounds the rows that are looked at
    value = 174.0                # with `tolerance` (absolute) or `relative_tolerance`; or range = [LOW, HIGH]
    tolerance = 1.0
    source = "..."               # of the expected value
    published = "..."            # what others report, for the table of findings; may be left out

Instead of `table`, `figure = "..."` takes a figure that the analysis prints (with `group = "..."` where several groups
have one), `summary = "rail_seats.0.max_force_n"` a number of summary.json. `[[ratio]]` has the same keys, and `of` and
`over`, names of two runs: the quantity of the one over that of the other.
"""

import csv
import json
import math
import tomllib
from dataclasses import dataclass, field
from pathlib import Path

HERE = {"run", "ratio"}
OF_RUN = {"name", "title", "changes", "by", "analyze", "expected"}
WHERE = {"table", "column", "row", "nearest", "take", "at_largest", "between", "figure", "group", "summary"}
OF_VALUE = WHERE | {"quantity", "value", "tolerance", "relative_tolerance", "range", "source", "published"}
TAKE = {
    "largest": max,
    "smallest": min,
    "first": lambda values: values[0],
    "last": lambda values: values[-1],
    "smallest_share": lambda values: min(values) / max(values),
    "mean": lambda values: sum(values) / len(values),
}


class ExpectedError(Exception):
    """`expected.toml` or the run's files do not allow the judgement; the text says what and where."""


@dataclass
class Expectation:
    """One quantity and the bounds it has to lie in."""

    quantity: str
    where: dict
    low: float
    high: float
    source: str
    published: str = ""
    runs: tuple[str, str] | None = None  # of, over: a ratio

    def target(self) -> str:
        return f"{self.low:.4g} to {self.high:.4g}"


@dataclass
class CaseRun:
    """One run of the case, with the changes that make it."""

    name: str = ""
    title: str = ""
    changes: dict = field(default_factory=dict)
    by: list = field(default_factory=lambda: ["cases/run"])
    analyze: list = field(default_factory=list)
    expected: list = field(default_factory=list)


@dataclass
class Judgement:
    """A quantity of a run, or of two, and whether it is what was expected."""

    expectation: Expectation
    run: str
    value: float

    @property
    def holds(self) -> bool:
        return self.expectation.low <= self.value <= self.expectation.high


def refuse_unknown(table: dict, known: set, where: str) -> None:
    for key in table:
        if key not in known:
            raise ExpectedError(f"unknown key '{key}' - {where} - known are: {', '.join(sorted(known))}")


def bounds(table: dict, where: str) -> tuple[float, float]:
    given = [key for key in ("tolerance", "relative_tolerance", "range") if key in table]
    if len(given) != 1 or ("range" in table) == ("value" in table):
        raise ExpectedError(f"give value with tolerance or relative_tolerance, or range - {where}")
    if "range" in table:
        return tuple(table["range"])
    reach = table["tolerance"] if "tolerance" in table else table["relative_tolerance"] * abs(table["value"])
    return table["value"] - reach, table["value"] + reach


def read_expectation(table: dict, path: Path, runs: tuple[str, str] | None = None) -> Expectation:
    where = f"{path}: '{table.get('quantity', 'a quantity without a name')}'"
    refuse_unknown(table, OF_VALUE | ({"of", "over"} if runs else set()), where)
    for key in ("quantity", "source"):
        if key not in table:
            raise ExpectedError(f"'{key}' is missing - {where}")
    low, high = bounds(table, where)
    place = {key: value for key, value in table.items() if key in WHERE}
    return Expectation(table["quantity"], place, low, high, table["source"], table.get("published", ""), runs)


def read_ratio(table: dict, path: Path) -> Expectation:
    if not {"of", "over"} <= table.keys():
        raise ExpectedError(f"'of' or 'over' is missing - {path}: '{table.get('quantity', '')}'")
    return read_expectation(table, path, (table["of"], table["over"]))


def read_expected(folder: Path) -> tuple[list[CaseRun], list[Expectation]]:
    """Runs of the case in `folder`, and the expected ratios between them."""
    path = folder / "expected.toml"
    if not path.exists():
        return [CaseRun()], []
    try:
        text = tomllib.loads(path.read_text())
    except tomllib.TOMLDecodeError as error:
        raise ExpectedError(f"{error} - {path}") from error
    refuse_unknown(text, HERE, str(path))
    runs = []
    for table in text.get("run", []):
        refuse_unknown(table, OF_RUN, f"{path}: run '{table.get('name', '')}'")
        values = [read_expectation(value, path) for value in table.get("expected", [])]
        runs.append(CaseRun(**{**table, "expected": values}))
    return runs, [read_ratio(table, path) for table in text.get("ratio", [])]


def read_columns(path: Path) -> dict[str, list[float]]:
    """Columns of an analysis table by name, without the unit."""
    if not path.exists():
        raise ExpectedError(f"there is no such table of the analysis - {path} - see the notes of coupler analyze")
    with path.open(newline="") as file:
        head, *rows = csv.reader(file)
    names = [title.rsplit(" [", 1)[0] for title in head]
    return {name: [float(row[i]) for row in rows] for i, name in enumerate(names)}


def column_of(columns: dict, name: str, where: str) -> list[float]:
    if name not in columns:
        raise ExpectedError(f"no column '{name}' - {where} - there are: {', '.join(columns)}")
    return columns[name]


def value_in_table(where: dict, folder: Path) -> float:
    path = folder / "analysis" / (where["table"] + ".csv")
    columns = read_columns(path)
    values = column_of(columns, where["column"], str(path))
    low, high = where.get("between", (-math.inf, math.inf))
    rows = [i for i, place in enumerate(next(iter(columns.values()))) if low <= place <= high]
    if not rows:
        raise ExpectedError(f"no row between {low} and {high} - {path}")
    if "row" in where:
        return values[rows[where["row"]]]
    if "nearest" in where:
        return min((values[i] for i in rows), key=lambda value: abs(value - where["nearest"]))
    if "at_largest" in where:
        leading = column_of(columns, where["at_largest"], str(path))
        return values[max(rows, key=lambda i: leading[i])]
    return TAKE[where["take"]]([values[i] for i in rows])


def value_of_figure(where: dict, path: Path) -> float:
    name, group = where["figure"], where.get("group")
    with path.open(newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["figure"] == name and group in (None, row["group"])]
    values = [float(row["value"]) for row in rows]
    if len(values) != 1:
        raise ExpectedError(f"{len(values)} figures are called '{name}' - {path}")
    return values[0]


def value_of(where: dict, folder: Path) -> float:
    """The quantity at `where` of the run in `folder`."""
    if "table" in where:
        return value_in_table(where, folder)
    if "figure" in where:
        return value_of_figure(where, folder / "analysis" / "figures.csv")
    value = json.loads((folder / "summary.json").read_text())
    for key in where["summary"].split("."):
        value = value[int(key) if isinstance(value, list) else key]
    return float(value)


def judge(runs: list[CaseRun], ratios: list[Expectation], out: Path) -> list[Judgement]:
    """Every expectation of `runs`, whose results lie in `out`/NAME, and the ratios of those of them that were made."""
    made = {run.name for run in runs}
    judgements = [Judgement(e, run.name, value_of(e.where, out / run.name)) for run in runs for e in run.expected]
    for ratio in ratios:
        if not made.issuperset(ratio.runs):
            continue
        upper, lower = (value_of(ratio.where, out / name) for name in ratio.runs)
        judgements.append(Judgement(ratio, " over ".join(ratio.runs), upper / lower))
    return judgements


def table_of(judgements: list[Judgement]) -> str:
    """For people to read."""
    lines = []
    for j in judgements:
        e = j.expectation
        name = e.quantity + (f" ({j.run})" if j.run else "")
        lines.append(f"  {'ok    ' if j.holds else 'MISSED'} {name}: {j.value:.5g}, expected {e.target()} ({e.source})")
        if e.published:
            lines.append(f"         published: {e.published}")
    return "\n".join(lines)
