#!/usr/bin/python3
"""A rail that is one mass on a spring, as the participant `fem` of a coupled run.

Written from proto/README.md alone; the sections named are its. It shares nothing with the rest of this tree but the
schema: `coupling.fbs` and the modules that `flatc --python` makes of it lie in the script's folder. The rail moves
along the normal axis of one rail seat with one cell; its figures are `[oscillator.implicit]` of the case.
"""
import argparse
import math
import os
import pathlib
import struct
import sys
import time
import tomllib

import flatbuffers
import xxhash
import zmq

FOLDER = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(FOLDER))
from proto.fbs import (Advance, Body, Bye, Capabilities, Commit, Configure, Configured, Fact, Fault,  # noqa: E402
                       Field, FieldSpec, Heartbeat, Hello, Interface, LoadMode, Message, Phase, Reject, Result,
                       Rollback, SeatRegistration, Welcome)

MAGIC = b"QFC1"
PROTOCOL_VERSION = (1, 2)
NORMAL = 2  # seat axis
USAGE, UNAVAILABLE, NUMERICS, PROTOCOL, CONFIG = 64, 69, 75, 76, 78
KIND = Body.Body


class Failure(Exception):
    """Ends the process with `code` (section 10)."""

    def __init__(self, code, text):
        super().__init__(text)
        self.code = code


# Section 3: frames -----------------------------------------------------------------------------------------------

def frame(payload):
    return MAGIC + struct.pack("<IQ", len(payload), xxhash.xxh3_64_intdigest(payload)) + payload


def unframe(data):
    if len(data) < 28 or data[:4] != MAGIC:
        raise Failure(PROTOCOL, "a frame does not begin with QFC1")
    size, digest = struct.unpack("<IQ", data[4:16])
    payload = data[16:]
    if size != len(payload) or digest != xxhash.xxh3_64_intdigest(payload) or payload[4:8] != MAGIC:
        raise Failure(PROTOCOL, "size, hash or identifier of a frame is wrong")
    return Message.Message.GetRootAs(payload, 0)


# Tables of the schema, from and to plain values ------------------------------------------------------------------

def table(b, module, **values):
    """A table of `module` with the given fields; texts and lists are written before it is begun."""
    ready = {}
    for name, value in values.items():
        if isinstance(value, str):
            value = b.CreateString(value)
        elif isinstance(value, list):
            value = vector(b, value)
        ready[name] = value
    module.Start(b)
    for name, value in ready.items():
        getattr(module, "Add" + name)(b, value)
    return module.End(b)


class Tables(list):
    """Offsets of tables that were written before."""


def vector(b, items):
    of_tables = isinstance(items, Tables)
    width = 4 if of_tables else 8
    b.StartVector(width, len(items), width)
    for item in reversed(items):
        b.PrependUOffsetTRelative(item) if of_tables else b.PrependFloat64(item)
    return b.EndVector()


def written_fields(b, fields):
    return Tables(table(b, Field, Name=name, Values=values) for name, values in fields.items())


def read(kind, module, message):
    """The body of a message as a table of `module`."""
    body = getattr(module, kind)()
    part = message.Body()
    body.Init(part.Bytes, part.Pos)
    return body


def read_fields(advance):
    fields = {}
    for i in range(advance.DataLength()):
        field = advance.Data(i)
        name, values = field.Name().decode(), [field.Values(k) for k in range(field.ValuesLength())]
        if name in fields or len(values) != 3 or not all(map(math.isfinite, values)):
            raise Failure(PROTOCOL, f"field '{name}' comes twice, has a wrong length or a number that is not finite")
        fields[name] = values
    return fields


# Section 8: what the rail does -----------------------------------------------------------------------------------

class Rail:
    """Mass, ground spring and pad, all along the normal axis."""

    def __init__(self, values):
        self.mass, self.stiffness = values["mass_kg"], values["ground_stiffness_n_per_m"]
        self.u, self.v = values["initial_displacement_m"], values["initial_velocity_m_per_s"]
        self.pad_stiffness = self.pad_damping = self.preload = 0.0
        self.cutoff = False

    def solve(self, h, k, c, load):
        """M (v1 - v0)/H + (K + k)(u0 + u1)/2 + c (u1 - u0)/H = load, u1 = u0 + H (v0 + v1)/2. Returns the window means
        of displacement and velocity."""
        before, total = self.u, self.stiffness + k
        mean = (2 * self.mass / h * self.v - total * self.u + load) / (2 * self.mass / h + h / 2 * total + c)
        self.u += h * mean
        self.v = 2 * mean - self.v
        return (before + self.u) / 2, mean

    def solve_robin(self, h, x, y, carry):
        """The window with the pad against the sleeper's mean motion; returns the pad's mean force on the sleeper."""
        k, c, begin = self.pad_stiffness, self.pad_damping, (self.u, self.v)
        u, v = self.solve(h, k, c, k * x + c * y + carry)
        force = k * (u - x) + c * (v - y)
        if not self.cutoff or force <= self.preload:
            return force
        self.u, self.v = begin  # the pad has let go: only its clip pulls
        self.solve(h, 0.0, 0.0, carry - self.preload)
        return self.preload

    def advance(self, h, mode, fields):
        if mode == LoadMode.LoadMode.prescribed_force:
            used = fields["force_mean"][NORMAL]
            self.solve(h, 0.0, 0.0, -used)
            return {"force_used": along_normal(used)}
        carry = fields["force_carry"][NORMAL]
        x, y = (fields[name][NORMAL] for name in ("sleeper_mean_displacement", "sleeper_mean_velocity"))
        robin = self.solve_robin(h, x, y, carry)
        return {"force_robin": along_normal(robin), "force_used": along_normal(robin - carry)}

    def motion(self):
        return {"rail_displacement": along_normal(self.u), "rail_velocity": along_normal(self.v)}


def along_normal(value):
    return [0.0, 0.0, value]


# Section 9: what the seat's only cell does ------------------------------------------------------------------------

def registration(seat):
    """The cell lies at the origin and follows the mass: rotations about it leave it there, forces have no moment."""
    first, second = seat.get("longitudinal_axis", [1, 0, 0]), seat.get("lateral_axis", [0, 1, 0])
    third = [first[(i + 1) % 3] * second[(i + 2) % 3] - first[(i + 2) % 3] * second[(i + 1) % 3] for i in range(3)]
    axes = [list(map(float, axis)) for axis in (first, second, third)]
    response = [axis[e] for e in range(3) for axis in axes] + [0.0] * 9
    resultants = [value for axis in axes for value in axis + [0.0, 0.0, 0.0]]
    return {"Name": seat["name"], "Points": list(map(float, seat["origin_m"])), "Weights": [1.0],
            "RigidResponse": response, "ForceResultants": resultants}


INCOMING = {"sleeper_mean_displacement": "m", "sleeper_mean_velocity": "m/s", "force_carry": "N", "force_mean": "N"}
OUTGOING = {"rail_displacement": "m", "rail_velocity": "m/s", "force_robin": "N", "force_used": "N"}


# Sections 4 to 6: the session -------------------------------------------------------------------------------------

class Session:
    """A window takes microseconds here, so one thread serves both the socket and the solver."""

    def __init__(self, arguments, token, case_bytes, case):
        self.arguments, self.token, self.case_bytes = arguments, token, case_bytes
        self.seat, self.rail = case["rail_seat"][0], Rail(case["oscillator"]["implicit"])
        self.kept = (self.rail.u, self.rail.v)  # of the last commit
        self.state, self.window, self.iteration = "greeting", 0, 0  # window and iteration that come next
        self.session = self.sent = self.received = self.progress = 0
        self.mode, self.window_s = LoadMode.LoadMode.robin, 0.0
        self.last_answer = None  # (sequence of the Advance, what say() needs)
        self.heartbeat_s, self.next_beat = None, math.inf

    def run(self):
        self.socket = zmq.Context.instance().socket(zmq.DEALER)
        self.socket.setsockopt(zmq.LINGER, 2000)
        monitor = self.socket.get_monitor_socket(zmq.EVENT_DISCONNECTED)
        self.socket.connect(self.arguments.endpoint)
        poller = zmq.Poller()
        poller.register(self.socket, zmq.POLLIN)
        poller.register(monitor, zmq.POLLIN)
        self.say(KIND.Hello, self.hello)
        deadline = time.monotonic() + 30.0
        while self.state != "finished":
            ready = dict(poller.poll(50))
            if self.socket in ready:
                self.take(self.socket.recv())
            elif monitor in ready or (self.state == "greeting" and time.monotonic() > deadline):
                raise Failure(UNAVAILABLE, "the coupler is gone")
            if time.monotonic() >= self.next_beat:
                self.beat()
        self.socket.close()

    def say(self, kind, body, in_reply_to=0):
        """Sends the message whose body the call `body`(builder) writes."""
        b = flatbuffers.Builder(1024)
        part = body(b)
        self.sent += 1
        b.Finish(table(b, Message, Session=self.session, Sequence=self.sent, InReplyTo=in_reply_to, BodyType=kind,
                       Body=part), file_identifier=MAGIC)
        self.socket.send(frame(bytes(b.Output())))

    def beat(self):
        self.next_beat = time.monotonic() + self.heartbeat_s
        self.say(KIND.Heartbeat, lambda b: table(b, Heartbeat, Window=self.window, Progress=self.progress))

    def take(self, data):
        message = unframe(data)
        if self.last_answer and message.BodyType() == KIND.Advance and message.Sequence() == self.last_answer[0]:
            self.say(KIND.Result, self.last_answer[1], message.Sequence())
            return
        self.received += 1
        if message.Sequence() != self.received:
            raise Failure(PROTOCOL, f"message {message.Sequence()} instead of {self.received}")
        kind = message.BodyType()
        name = next((n for n, value in vars(KIND).items() if value == kind), "?")
        handler = getattr(self, "on_" + name.lower(), None)
        if handler is None:
            raise Failure(PROTOCOL, f"{name} is not for this participant - state {self.state}")
        if kind not in (KIND.Welcome, KIND.Reject) and message.Session() != self.session:
            raise Failure(PROTOCOL, f"{name} of another session")
        handler(message)

    def require(self, condition, name):
        if not condition:
            raise Failure(PROTOCOL, f"{name} is out of order - state {self.state}, window {self.window}")

    def hello(self, b):
        return table(b, Hello, Name=self.arguments.name, ProtocolMajor=PROTOCOL_VERSION[0],
                     ProtocolMinor=PROTOCOL_VERSION[1],
                     SchemaHash=xxhash.xxh3_64_intdigest((FOLDER / "coupling.fbs").read_bytes()),
                     CaseHash=xxhash.xxh3_64_intdigest(self.case_bytes), SessionToken=self.token,
                     BuildId="spring_rail.py", Capabilities=table(b, Capabilities, Robin=True, Rollback=True))

    def on_welcome(self, message):
        self.require(self.state == "greeting", "Welcome")
        welcome = read("Welcome", Welcome, message)
        self.session, self.heartbeat_s = welcome.Session(), welcome.HeartbeatS()
        self.state, self.next_beat = "registered", 0.0
        self.say(KIND.Interface, self.interface)

    def interface(self, b):
        specs = [(n, u, False) for n, u in INCOMING.items()] + [(n, u, True) for n, u in OUTGOING.items()]
        fields = Tables(table(b, FieldSpec, Name=n, Unit=u, Components=3, Outgoing=out) for n, u, out in specs)
        seats = Tables([table(b, SeatRegistration, **registration(self.seat))])
        return table(b, Interface, Fields=fields, Seats=seats)

    def on_reject(self, message):
        raise Failure(PROTOCOL, "rejected: " + read("Reject", Reject, message).Reason().decode())

    def on_configure(self, message):
        self.require(self.state == "registered", "Configure")
        request = read("Configure", Configure, message)
        self.window_s, self.mode, self.state = request.WindowS(), request.Mode(), "configured"
        self.rail.pad_stiffness, self.rail.pad_damping = request.Stiffness(NORMAL), request.Damping(NORMAL)
        self.rail.preload, self.rail.cutoff = request.Preload(NORMAL), bool(request.TensionCutoff(NORMAL))
        self.say(KIND.Configured, lambda b: table(b, Configured, Facts=Tables()), message.Sequence())

    def on_start(self, message):
        self.require(self.state == "configured", "Start")
        self.state = "marching"
        used = along_normal(0.0)
        self.answer(message, -1, 0, {**self.rail.motion(), "force_robin": used, "force_used": used}, 0.0)

    def on_advance(self, message):
        request = read("Advance", Advance, message)
        window, iteration = request.Window(), request.Iteration()
        if self.state == "marching" and request.Phase() == Phase.Phase.march and (window, iteration) == (
                self.window, self.iteration):
            begin = time.monotonic()
            given = self.rail.advance(request.WindowS(), self.mode, read_fields(request))
            given.update(self.rail.motion())
            if not all(math.isfinite(value) for values in given.values() for value in values):
                raise Failure(NUMERICS, f"the solution is not finite - window {window}")
            self.progress += 1
            self.state = "advanced"
            self.answer(message, window, iteration, given, time.monotonic() - begin)
        else:
            self.require(False, "Advance")

    def answer(self, message, window, iteration, fields, seconds):
        def result(b):
            return table(b, Result, Phase=Phase.Phase.march, Window=window, Iteration=iteration, ComputeS=seconds,
                         Data=written_fields(b, fields))
        self.last_answer = (message.Sequence(), result)
        self.say(KIND.Result, result, message.Sequence())

    def on_commit(self, message):
        window = read("Commit", Commit, message).Window()
        self.require(self.state == "advanced" and window == self.window, "Commit")
        self.kept, self.state = (self.rail.u, self.rail.v), "marching"
        self.window, self.iteration = self.window + 1, 0

    def on_rollback(self, message):
        window = read("Rollback", Rollback, message).Window()
        self.require(self.state == "advanced" and window == self.window, "Rollback")
        self.rail.u, self.rail.v = self.kept
        self.state, self.iteration = "marching", self.iteration + 1

    def on_heartbeat(self, message):
        pass

    def on_fault(self, message):
        raise Failure(UNAVAILABLE, "the coupler stopped: " + read("Fault", Fault, message).Text().decode())

    def on_finish(self, message):
        self.require(self.state not in ("greeting", "advanced"), "Finish")
        facts = {"oscillator.implicit.x": self.rail.u, "oscillator.implicit.v": self.rail.v,
                 "oscillator.implicit.time_s": self.window * self.window_s}

        def bye(b):
            return table(b, Bye, Facts=Tables(table(b, Fact, Key=k, Number=v) for k, v in facts.items()))
        self.say(KIND.Bye, bye, message.Sequence())
        self.state = "finished"


# Sections 1 and 10: the process -----------------------------------------------------------------------------------

def parsed(argv):
    parser = argparse.ArgumentParser(description="A spring-mass rail for coupled runs.")
    commands = parser.add_subparsers(dest="command", required=True)
    for name in ("check", "participant"):
        command = commands.add_parser(name)
        command.add_argument("--case", required=True)
        if name == "participant":
            command.add_argument("--endpoint", required=True)
            command.add_argument("--out", default=".")
            command.add_argument("--name", required=True)
    return parser.parse_args(argv)


def checked_case(data):
    case = tomllib.loads(data.decode())
    seats = case.get("rail_seat", [])
    if len(seats) != 1 or seats[0].get("cells") != [1, 1]:
        raise Failure(CONFIG, "a spring rail has one rail seat with one cell")
    known = {"mass_kg", "ground_stiffness_n_per_m", "initial_displacement_m", "initial_velocity_m_per_s"}
    if set(case.get("oscillator", {}).get("implicit", {})) != known:
        raise Failure(CONFIG, "oscillator.implicit needs exactly: " + ", ".join(sorted(known)))
    return case


def main():
    arguments = parsed(sys.argv[1:])
    data = pathlib.Path(arguments.case).read_bytes()
    case = checked_case(data)
    if arguments.command == "check":
        return
    token = os.environ.get("QDEM_FEM_SESSION_TOKEN")
    if not token:
        raise Failure(USAGE, "QDEM_FEM_SESSION_TOKEN is not set")
    session = Session(arguments, token, data, case)
    try:
        session.run()
    except Failure as failure:
        if failure.code != UNAVAILABLE and session.session:
            session.say(KIND.Fault, lambda b: table(b, Fault, Code=failure.code, Text=str(failure)))
        raise


if __name__ == "__main__":
    try:
        main()
    except Failure as error:
        print(f"spring_rail.py: {error}", file=sys.stderr)
        sys.exit(error.code)
