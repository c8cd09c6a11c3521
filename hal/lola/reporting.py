"""The status that the process of LoLA publishes."""

from __future__ import annotations

import msgspec

from hal.lola.core import Core
from hal.lola.session import Counts, Session
from hal.lola.shared import LolaStatus
from hal.lola.standing import StandingState


def status_of(
    session: Session | None,
    core: Core[StandingState],
    counts: Counts,
    now_ns: int,
    *,
    silent: bool,
    real_time: bool,
    trouble: str,
) -> LolaStatus:
    """What we are at. `silent`: LoLA has sent nothing for a while."""
    counted = LolaStatus(
        now_ns,
        False,
        real_time,
        trouble=trouble,
        ticks=counts.ticks,
        late=counts.late,
        bad=counts.bad,
        connections=counts.connections,
    )
    if session is None or session.state is None or session.sensors is None:
        why = f"LoLA does not answer: {trouble or 'no message yet'}"
        return msgspec.structs.replace(counted, refusal=why, head_refusal=why)
    state, sensors = session.state, session.sensors
    report = core.report(state)
    velocity, odometry = report.velocity, report.odometry
    why_not = "LoLA has gone silent" if silent else None
    return msgspec.structs.replace(
        counted,
        connected=not silent,
        mode=state.mode,
        phase=report.phase,
        fallen=state.balance.fallen,
        lifted=state.balance.lifted,
        moving=report.moving,
        leaving=state.leaving,
        velocity=(velocity.x, velocity.y, velocity.yaw),
        odometry=(odometry.x, odometry.y, odometry.yaw),
        refusal=why_not or core.refusal(state),
        head_refusal=why_not or core.head_refusal(state),
        hot=session.hot(),
        soft=session.soft(),
        body_id=sensors.body_id,
        version=sensors.version,
        battery_current_a=sensors.battery_current_a,
    )
