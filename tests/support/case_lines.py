"""Keys of a case file with their lines, and what the schema says of them. For tests written in Python."""
import re
import tomllib

HEADER = re.compile(r"^\s*\[{1,2}([\w.]+)\]{1,2}")
ASSIGNMENT = re.compile(r"^(\w+)\s*=\s*(.*?)\s*(#.*)?$")


class Key:
    """One `key = value` line; `schema` is None where the schema knows no such key."""

    def __init__(self, line, section, name, value, root):
        self.line, self.section, self.name, self.value = line, section, name, value
        table = at(root, section)
        self.schema = table.get("properties", {}).get(name) if table else None
        self.required = name in table.get("required", []) if table else False

    @property
    def full_name(self):
        return f"{self.section}.{self.name}"


def at(schema, section):
    """The schema of a section, of an element where it is an array of tables."""
    for part in section.split("."):
        schema = schema.get("properties", {}).get(part)
        if schema is None:
            return None
        schema = schema.get("items", schema)
    return schema


def keys_of(text, schema):
    section, keys = "", []
    for number, line in enumerate(text.splitlines()):
        header = HEADER.match(line)
        assignment = ASSIGNMENT.match(line)
        if header:
            section = header.group(1)
        elif assignment:
            value = tomllib.loads("v = " + assignment.group(2))["v"]
            keys.append(Key(number, section, assignment.group(1), value, schema))
    return keys


def with_line(text, number, line):
    """The text with another line (None: without it, a list: several)."""
    lines = text.splitlines()
    lines[number:number + 1] = [] if line is None else [line] if isinstance(line, str) else line
    return "\n".join(lines) + "\n"
