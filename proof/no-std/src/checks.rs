//! Real work with each crate; `None` when a result is not the expected one.

use core::hint::black_box;

use handwheel::{Action, Arbiter, Driver, Input, Panel, Settings, Shown, UnitId, WheelQuantiser};
use pattern_codec::container::{Header, Verifier, Writer, open};
use pattern_codec::dance::{Data, DataHeader, Easing, Law, Motor, Packing, Timing};
use pattern_codec::engraving::{Axis, Builder, Decoder, Format, JointPulses};
use pose_pt::{
    AxisLimits, Convention, Cut, Interpolation, Knot, Locator, Path, Platform, PoseVector, PtTable,
    PvtTable,
};
use proto3964r::{Check, Config, Event, Priority, Station, Transmit, frame};
use pulse_interp::{Arc, AxisLoop, Line, LoopSettings, Pace, Rule, ScaleRatio, Turn};
use rk512::{Area, Client, DataBlock, Memory, Outcome, Server};
use scara_kin::nalgebra::{Point2, Vector2};
use scara_kin::{Arm, Elbow, Joints};
use stepper_sync::{
    Accumulation, LatchWrites, Latches, Phases, Position, Ramp, RampLimits, Rate, SpeedLaw,
    Stepping, Timer, Trains, Wiring,
};

/// The checks; the number of each is its exit status.
pub const ALL: &[fn() -> Option<()>] = &[
    inverse,
    follow,
    pose,
    tables,
    trains,
    ramp,
    dance,
    interpolation,
    closed_loop,
    records,
    container,
    dance_header,
    stations,
    read_data_block,
    unit_telegrams,
    panel,
];

/// A thousandth of a micrometre: far above the rounding of an arm of 264 mm, far below any machine.
const CLOSE_MM: f64 = 1e-6;

fn holds(condition: bool) -> Option<()> {
    condition.then_some(())
}

/// Inverse and forward kinematics, rates.
fn inverse() -> Option<()> {
    let arm = Arm::new(black_box(132.0), 132.0).ok()?;
    let point = Point2::new(black_box(150.0), 80.0);
    let solutions = arm.inverse(point).ok()?;
    for (_, joints) in solutions.iter() {
        holds((arm.forward(joints) - point).norm() < CLOSE_MM)?;
        let velocity = Vector2::new(black_box(10.0), -3.0);
        let rates = arm.joint_rates(joints, velocity).ok()?;
        holds((arm.tool_velocity(joints, rates) - velocity).norm() < CLOSE_MM)?;
    }
    holds(arm.inverse(Point2::new(black_box(264.5), 0.0)).is_err())
}

/// A line of 160 mm within 0.01 mm.
fn follow() -> Option<()> {
    let arm = Arm::new(black_box(132.0), 132.0).ok()?;
    let line = [
        Point2::new(-80.0, 100.0),
        Point2::new(80.0, black_box(100.0)),
    ];
    let waypoints = arm.follow(line, Elbow::Right, 0.01).ok()?;
    let mut last: Option<Joints> = None;
    for waypoint in waypoints {
        if let Some(from) = last {
            holds(arm.chord_bound(from, waypoint.joints) <= 0.01)?;
        }
        last = Some(waypoint.joints);
    }
    holds((arm.forward(last?) - line[1]).norm() < CLOSE_MM)
}

/// A panel on three locators.
fn platform() -> Option<Platform<3>> {
    let limits = [AxisLimits::new(-300.0, 300.0, 20.0, 100.0); 3];
    let anchors = [
        [-1500.0, -1000.0, 0.0],
        [1500.0, black_box(-1000.0), 0.0],
        [0.0, 1000.0, 0.0],
    ];
    let held = anchors.map(|anchor| Locator::new(anchor.into(), anchor.into(), limits));
    Platform::new(held).ok()
}

/// A way as PT and PVT tables within a strain.
fn tables() -> Option<()> {
    let platform = platform()?;
    let poses = [0.0, black_box(0.02)].map(|gamma| {
        PoseVector::new(0.0, 0.0, 100.0, 0.0, 0.0, gamma).to_isometry(Convention::ExtrinsicXyz)
    });
    let path = Path::new(&poses, Interpolation::Straight).ok()?;
    let table = PtTable::plan(&platform, &path, Cut::strain(0.01)).ok()?;
    holds(table.points().count() == 5 && table.strain_bound() <= 0.01)?;
    let mut knots = [Knot::default(); 33];
    let table = PvtTable::plan(&platform, &path, Cut::parts(32), &mut knots).ok()?;
    let last = table.points().last()?;
    holds((last.time_s - table.duration_s()).abs() < CLOSE_MM)?;
    holds(
        last.velocities
            .iter()
            .all(|velocity| velocity.amax() < CLOSE_MM),
    )
}

/// Pose to axes and back, with what the locators pull.
fn pose() -> Option<()> {
    let platform = platform()?;
    let vector = PoseVector::new(black_box(10.0), -20.0, 100.0, 0.01, 0.02, -0.03);
    let pose = vector.to_isometry(Convention::IntrinsicXyz);
    let mut axes = platform.checked_axes(&pose).ok()?;
    let body = platform.pose(&axes).ok()?;
    let back = PoseVector::from_isometry(&body.pose, Convention::IntrinsicXyz).vector;
    holds((back.position() - vector.position()).norm() < CLOSE_MM)?;
    holds((back.angles() - vector.angles()).norm() < CLOSE_MM)?;
    holds(body.strain.change.abs() < CLOSE_MM)?;
    axes.last_mut()?.y += black_box(0.5);
    holds(platform.pose(&axes).ok()?.strain.change > 0.4)?;
    axes.last_mut()?.y = 301.0;
    holds(platform.check_axes(&axes).is_err())
}

/// Trains that end together, timer reloads, positions.
fn trains() -> Option<()> {
    let timer = Timer::mcs51_mode1(black_box(11_059_200)).ok()?;
    let rate = Rate::from_millihertz(black_box(112_800)).ok()?;
    let half_period = timer.half_period(rate).ok()?.nearest();
    holds(timer.reload(half_period) == Ok(0xF00B))?;
    let trains = Trains::new(black_box([30, -7]), u32::try_from(half_period).ok()?).ok()?;
    holds(trains.edges().last()?.ticks == trains.end_ticks())?;
    let [fast, slow] = trains.axes();
    holds(fast.sum::<u64>() == slow.clone().sum())?;
    let mut ticks = 0;
    for reload in timer.reloads(slow) {
        ticks += reload.ok()?.ticks;
    }
    holds(ticks == trains.end_ticks())?;
    let mut position = Position::home();
    position.apply(trains.steps()).ok()?;
    holds(position.homing() == [-30, 7])
}

/// A rapid move whose axes end together.
fn ramp() -> Option<()> {
    let limits = RampLimits {
        start_millihertz: 0,
        max_millihertz: 2_000_000,
        accel_steps_per_s2: black_box(10_000),
    };
    let ramp = Ramp::new([4000, -1500], &limits, Rate::from_hz(1_000_000).ok()?).ok()?;
    holds(ramp.end_ticks() == 2_200_000)?;
    holds(ramp.edges().last()?.ticks == ramp.end_ticks())
}

/// A frame for two motors through accumulators, phases and latches.
fn dance() -> Option<()> {
    let tick = Rate::from_hz(1000).ok()?;
    let mut motors = Accumulation::new(SpeedLaw::CarrySigned, black_box(600), tick)
        .ok()?
        .motors();
    motors.set_speeds(black_box([119, -60]));
    let windings = Phases::new(Stepping::Half, Wiring::UNIPOLAR).ok()?;
    let mut phases = [windings.start(); 2];
    let mut latches = Latches::new();
    let mut position = Position::home();
    for _ in 0..200 {
        let steps = motors.tick();
        position.apply(steps).ok()?;
        for (phase, step) in phases.iter_mut().zip(steps) {
            *phase = windings.advance(*phase, step);
        }
        for write in LatchWrites::new(phases.map(|phase| Some(windings.byte(phase)))) {
            latches.write(write).ok()?;
        }
    }
    // 119 · 200 / 600 = 39.67; 39 half steps are 7 past a turn, 20 back are 4.
    holds(position.homing() == [-39, 20] && latches.outputs() == [9, 4])
/// A line, and an arc that ends where it should, at constant speed.
fn interpolation() -> Option<()> {
    let line = Line::new(black_box([30, -7])).ok()?;
    holds(line.steps(Rule::Centred).len() == 37)?;
    let arc = Arc::new(black_box([500, 0]), [-300, 400], Turn::CounterClockwise).ok()?;
    let (mut steps, mut pace) = (arc.steps(Rule::Centred), Pace::new(1000));
    let (mut at, mut ticks) = ([500, 0], 0);
    loop {
        let factor = steps.factor();
        let Some(step) = steps.next() else { break };
        at = [at[0] + step.dx(), at[1] + step.dy()];
        ticks += pace.interval(factor);
    }
    // 500 steps of radius by 2.2143 rad.
    holds(at == [-300, 400] && ticks.abs_diff(1_107_149) < 5000)?;
    holds(arc.moves().len() < arc.steps(Rule::Textbook).len())
}

/// An axis that has lost two steps.
fn closed_loop() -> Option<()> {
    let mut axis = AxisLoop::new(LoopSettings {
        ratio: ScaleRatio::new(black_box(5), 1).ok()?,
        dead_band_counts: 3,
        alarm_counts: 100,
    })
    .ok()?;
    holds(axis.correction(black_box(-10)) == Ok(2))?;
    holds(axis.correction(black_box(-101)).is_err())
}

/// Records to bytes and back, from a slice and from chunks.
fn records() -> Option<()> {
    let format = Format::default();
    let mut builder = Builder::new();
    let mut bytes = [0; 15];
    let slow = JointPulses {
        theta1: 45,
        theta2: -90,
        theta3: 6,
    };
    let records = builder
        .fast(Axis::Vertical, black_box(-70_000))
        .ok()?
        .chain(builder.slow(slow).ok()?);
    for (place, record) in bytes.chunks_exact_mut(3).zip(records) {
        place.copy_from_slice(&record.encode(&format));
    }
    let mut arm = Builder::new();
    let (mut decoder, mut input) = (Decoder::new(format), black_box(bytes.as_slice()));
    for located in format.records(black_box(&bytes)) {
        let located = located.ok()?;
        holds(decoder.decode(&mut input)?.ok()? == located)?;
        arm.track(located.record).ok()?;
    }
    holds(decoder.finish() == Ok(15) && arm.position() == builder.position())
}

/// A container that opens, and does not when a bit is wrong.
fn container() -> Option<()> {
    let payload = black_box([0x02, 0x0F, 0x9E]);
    let header = Header::engraving(&Format::default(), 1).ok()?;
    let (head, mut writer) = Writer::new(header);
    writer.update(&payload).ok()?;
    let mut file = [0; 23];
    let parts = head
        .iter()
        .chain(&payload)
        .copied()
        .chain(writer.finish().ok()?);
    for (place, byte) in file.iter_mut().zip(parts) {
        *place = byte;
    }
    holds(open(black_box(&file)).ok()?.payload() == payload)?;
    let mut verifier = Verifier::new();
    for chunk in file.chunks(5) {
        verifier.update(chunk).ok()?;
    }
    holds(verifier.finish() == Ok(header))?;
    *file.get_mut(17)? ^= 0x10;
    holds(open(black_box(&file)).is_err())
}

/// A turn planned, written as a C header, read back and danced.
fn dance_header() -> Option<()> {
    let start = Motor::new(Law::Reset, 600, Timing::DEFAULT).ok()?;
    let turn = start.turn(black_box(500), 25, Easing::Smooth).ok()?;
    let mut text = Text {
        bytes: [0; 1024],
        len: 0,
    };
    let header = DataHeader::new().with_packing(Packing::MaskedRuns);
    let frames = turn.map(|speed| [speed, 0, 7]);
    header.write(frames.clone(), &mut text).ok()?;
    let data = Data::<3>::read(core::str::from_utf8(text.bytes.get(..text.len)?).ok()?).ok()?;
    holds(data.frames().eq(frames))?;
    let mut motor = start;
    data.frames().for_each(|[speed, ..]| motor.run(speed));
    holds(motor.position() == 500)
}

/// A writer into fixed memory.
struct Text {
    bytes: [u8; 1024],
    len: usize,
}

impl core::fmt::Write for Text {
    fn write_str(&mut self, text: &str) -> core::fmt::Result {
        let end = self.len + text.len();
        let place = self.bytes.get_mut(self.len..end).ok_or(core::fmt::Error)?;
        place.copy_from_slice(text.as_bytes());
        self.len = end;
        Ok(())
    }
}

/// One telegram from station to station, and the same block without a link.
fn stations() -> Option<()> {
    use proto3964r::Instant;
    let mut plc = Station::<64>::new(Config::siemens_3964r(Priority::High));
    let mut scale = Station::<64>::new(Config::siemens_3964r(Priority::Low));
    let (now, mut wire) = (Instant::ZERO, [0; 16]);
    let payload = black_box(b"tare \x10\x03");
    plc.send(now, payload).ok()?;
    for _ in 0..4 {
        while let Some(Transmit::Bytes(bytes)) = plc.poll_transmit(now, &mut wire) {
            scale.handle_bytes(now, bytes);
        }
        while let Some(Transmit::Bytes(bytes)) = scale.poll_transmit(now, &mut wire) {
            plc.handle_bytes(now, bytes);
        }
    }
    holds(scale.poll_event() == Some(Event::Received(payload)))?;
    holds(plc.poll_event() == Some(Event::Sent { len: payload.len() }))?;
    let (mut body, mut buffer) = ([0; 24], [0; 8]);
    let len = frame::encode(payload, Check::Bcc, &mut body).ok()?;
    let (decoded, rest) = frame::decode(body.get(..len)?, Check::Bcc, &mut buffer).ok()?;
    holds(decoded == payload && rest.is_empty())
}

/// A job of two telegrams each way.
fn read_data_block() -> Option<()> {
    use rk512::{Config, Instant};
    let now = Instant::ZERO;
    let mut db5 = [0; 200];
    let mut plc = Memory::new([DataBlock::db(5, &mut db5)]);
    let mut client = Client::<256>::new(Config::DEFAULT);
    let mut server = Server::new(Config::DEFAULT);
    let mut exchange = |client: &mut Client<256>| {
        while let Some(command) = client.poll_transmit(now) {
            client.handle_delivered(now);
            server.handle_block(&command, &mut plc);
            while let Some(reaction) = server.poll_transmit() {
                server.handle_delivered(now);
                client.handle_block(now, &reaction);
            }
        }
    };
    client
        .send(Area::db(5, 10), black_box(&[0x12, 0x34]))
        .ok()?;
    exchange(&mut client);
    holds(matches!(client.poll_outcome(), Some(Outcome::Sent { .. })))?;
    client.fetch(Area::db(5, 10), black_box(65)).ok()?;
    exchange(&mut client);
    let Some(Outcome::Fetched { data, .. }) = client.poll_outcome() else {
        return None;
    };
    holds(data.len() == 130 && data.starts_with(&[0x12, 0x34]))
}

/// Status request, reply, and a screen in display blocks.
fn unit_telegrams() -> Option<()> {
    use handwheel::{Command, Event, Instant, Model, Timing};
    let (now, model) = (Instant::ZERO, Model::Hbls);
    let mut driver = Driver::new(model, Timing::DEFAULT);
    let mut buffer = [0; handwheel::MAX_COMMAND];
    holds(driver.poll_transmit(now, &mut buffer).ok()? == Some(&[0x23]))?;
    holds(driver.handle_delivered(now).is_none())?;
    let event = driver.handle_block(now, black_box(&[0x30, 0x43, 0x52]))?;
    holds(matches!(
        event,
        Event::Status {
            connected: true,
            ..
        }
    ))?;
    let (mut shown, mut letters) = (Shown::UNKNOWN, 0);
    while let Some(block) = shown.update(&handwheel::Screen::BLANK, model) {
        driver.send_lcd(&block).ok()?;
        let telegram = driver.poll_transmit(now, &mut buffer).ok()??;
        let Ok(Command::Lcd(commands)) = Command::decode(model, black_box(telegram)) else {
            return None;
        };
        for command in commands {
            if let handwheel::LcdCommand::Text(text) = command.ok()? {
                letters += text.len();
            }
        }
        holds(driver.handle_delivered(now).is_none())?;
        holds(matches!(
            driver.handle_block(now, &[0x6C, 0x31]),
            Some(Event::Lcd { .. })
        ))?;
    }
    holds(letters == 128)
}

/// A jog that both switches allow and one stops.
fn panel() -> Option<()> {
    use handwheel::{Key, Position, Status};
    let wheel = WheelQuantiser::new(black_box(100), 10).ok()?;
    let mut platform = Arbiter::<3>::new();
    let mut panel = Panel::new(UnitId(1), Settings::new(wheel)).ok()?;
    let (w1, w2) = (Position::new(3).ok()?, Position::new(1).ok()?);
    let key = Key::new(3).ok();
    let course = [
        Input::Status(Status::Hbls { key: None, w1, w2 }),
        Input::Enable {
            left: false,
            right: false,
        },
        Input::Enable {
            left: true,
            right: true,
        },
        Input::Key(key),
        Input::Wheel(black_box(-57)),
        Input::Enable {
            left: true,
            right: false,
        },
    ];
    let mut actions = [None; 6];
    for (action, input) in actions.iter_mut().zip(course) {
        *action = panel.handle(input, &mut platform);
    }
    let [
        ..,
        Some(Action::Jog { speed_um_s, .. }),
        Some(Action::Stop(_)),
    ] = actions
    else {
        return None;
    };
    holds(speed_um_s == -5500)
}
