"""What the NAOqi backend says of itself when it is examined (`hal.health.Examined`)."""

from __future__ import annotations

from hal.errors import HalError
from hal.health import Finding
from hal.nao.joints import JOINT_NAMES
from hal.naoqi.body import Body
from hal.naoqi.camera import NaoqiCamera
from hal.naoqi.guard import Guard
from hal.naoqi.life import HELPERS, LIFE
from hal.naoqi.memory import temperature_status_key
from hal.naoqi.readiness import needs_rising, objection
from hal.naoqi.session import Session
from hal.naoqi.walk import NaoqiWalk

BATTERY_LOW = 0.2
CLOCK_MAX_NS = 10_000_000
"""Worse than this the joints of a turning head are not those of its picture."""
WANTED = (
    "ALMotion",
    "ALMemory",
    "ALVideoDevice",
    "ALRobotPosture",
    LIFE,
    *sorted({helper.service for helper in HELPERS} - {"ALMotion"}),
)


def findings(
    session: Session, body: Body, walk: NaoqiWalk, camera: NaoqiCamera, guard: Guard
) -> list[Finding]:
    """Everything in turn; never raises for what the robot answers."""
    return [*looked_at(session, body, camera), _stance(walk, body), _watchdog(guard)]


def looked_at(session: Session, body: Body, camera: NaoqiCamera) -> list[Finding]:
    """What can be told without the right to move: services, joints, clock, camera."""
    try:
        asked = [_services(session), _joints(session, body)]
    except HalError as error:
        asked = [Finding("naoqi", "fail", str(error), "does NAOqi run, and is the network well?")]
    return [*asked, _clock(body, camera), *_camera(camera)]


def _services(session: Session) -> Finding:
    missing = [name for name in WANTED if not session.has(name)]
    if missing:
        advice = (
            "what moves the robot by itself cannot be switched off where its service is missing"
        )
        return Finding("naoqi services", "warn", f"missing: {', '.join(missing)}", advice)
    return Finding("naoqi services", "ok", f"all {len(WANTED)} there")


def _joints(session: Session, body: Body) -> Finding:
    keys = [temperature_status_key(name) for name in JOINT_NAMES]
    values = session.call("ALMemory", "getListData", keys)
    hot = [
        name
        for name, value in zip(JOINT_NAMES, values, strict=True)
        if isinstance(value, int | float) and value > 0
    ]
    state = body.latest()
    text = f"warmest {state.temperature_max_c:.0f} C, battery {state.battery:.0%}"
    if hot:
        return Finding("joints", "warn", f"hot: {', '.join(hot)}; {text}", "let them cool")
    if state.battery < BATTERY_LOW:
        return Finding("joints", "warn", text, "charge it")
    return Finding("joints", "ok", text)


def _stance(walk: NaoqiWalk, body: Body) -> Finding:
    if walk.error is not None:
        return Finding("walk", "fail", walk.error, "see the daemon's log")
    against = objection(body.sensed)
    if against is not None:
        return Finding("walk", "warn", against, "put it on its feet")
    rising = needs_rising(walk.stance.readiness)
    if rising is not None:
        return Finding("walk", "warn", rising, "a walk asked for makes it stand up, if allowed to")
    if walk.refusal is not None:
        return Finding("walk", "warn", f"last refused: {walk.refusal}")
    return Finding("walk", "ok", "stands, ready to walk")


def _watchdog(guard: Guard) -> Finding:
    if guard.objection is not None:
        return Finding("watchdog", "fail", guard.objection, "nothing moves without it; see the log")
    return Finding("watchdog", "ok", f"watches; has stopped the robot {guard.fired} times")


def _clock(body: Body, camera: NaoqiCamera) -> Finding:
    if camera.other_clock:
        text = "the pictures have a clock of their own; they are aligned by their arrival"
        return Finding("clock", "warn", text, "expect half a picture's period of error")
    known = body.clock_offset()
    if known is None:
        return Finding("clock", "warn", "the robot's clock could not be compared with ours")
    offset, uncertainty = known
    text = f"the robot's is {offset / 1e9:+.3f} s from ours, to {uncertainty / 1e6:.1f} ms"
    if uncertainty > CLOCK_MAX_NS:
        return Finding("clock", "warn", text, "run the daemon on the robot, or use a wire")
    return Finding("clock", "ok", text)


def _camera(camera: NaoqiCamera) -> list[Finding]:
    width, height = camera.size
    shape = f"{camera.name}, {width}x{height} YUV422"
    if camera.error is not None:
        return [
            Finding("camera", "fail", f"{shape}: {camera.error}", "does another program use it?")
        ]
    locked = camera.locked
    if locked is None:
        return [Finding("camera", "warn", f"{shape}: no picture yet", "ask again in a second")]
    found = Finding("camera", "ok", shape)
    if locked.not_taken:
        text = f"did not take: {', '.join(locked.not_taken)}"
        advice = "colours may drift; learn the object anew when the light changes"
        return [found, Finding("camera controls", "warn", text, advice)]
    return [found, Finding("camera controls", "ok", "exposure, white balance and focus held")]
