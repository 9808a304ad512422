//! Real work with each crate; `None` when a result is not the expected one.

use core::hint::black_box;

use delta_kin::nalgebra::{Point3, Vector3};
use delta_kin::{Delta, Measured, Pace, Parameter, Path, Quantity};
use pattern_codec::container::{Header, Verifier, Writer, open};
use pattern_codec::engraving::{Axis, Builder, Decoder, Format, JointPulses};
use proto3964r::{Check, Config, Event, Priority, Station, Transmit, frame};
use rk512::{Area, Client, DataBlock, Memory, Outcome, Server};
use scara_kin::nalgebra::{Point2, Vector2};
use scara_kin::{Arm, Elbow, Joints};
use stepper_sync::{Position, Ramp, RampLimits, Rate, Timer, Trains};

/// The checks; the number of each is its exit status.
pub const ALL: [fn() -> Option<()>; 10] = [
    inverse,
    follow,
    trains,
    ramp,
    records,
    container,
    stations,
    read_data_block,
    delta,
    calibration,
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

fn thesis() -> Option<Delta> {
    Delta::new(black_box(42.0), 18.0, 120.0, 243.0).ok()
}

/// Inverse and forward kinematics of a Delta, rates, a line, a cylinder.
fn delta() -> Option<()> {
    let delta = thesis()?;
    let point = Point3::new(black_box(50.0), 50.0, -300.0);
    let pose = delta.pose_at(point).ok()?;
    holds((delta.forward(pose.angles()).ok()? - point).norm() < CLOSE_MM)?;
    let velocity = Vector3::new(black_box(10.0), -3.0, 1.0);
    let rates = pose.joint_rates(velocity).ok()?;
    holds((pose.platform_velocity(rates).ok()? - velocity).norm() < CLOSE_MM)?;
    holds(
        delta
            .inverse(Point3::new(50.0, 50.0, black_box(100.0)))
            .is_err(),
    )?;
    let line = Path::line(point, Point3::new(-50.0, 50.0, -300.0)).ok()?;
    let pace = Pace::new(200.0, [3.0; 3]).ok()?;
    let last = delta.follow(line, 0.01, pace).ok()?.last()?;
    holds((last.point - line.point_at(1.0)).norm() < CLOSE_MM)?;
    let workspace = delta.workspace();
    holds(workspace.covers_cylinder(black_box(60.0), [-290.0, -260.0], 1.0))?;
    holds(
        workspace
            .horizontal_slice(-260.0, 8)
            .all(|edge| workspace.contains(edge)),
    )
}

/// A lower arm that is longer than drawn.
fn calibration() -> Option<()> {
    let drawn = thesis()?;
    let mut arms = *drawn.arms();
    arms[1].lower += black_box(0.5);
    let real = drawn.with_arms(arms).ok()?;
    let mut measured = [Measured {
        angles: Vector3::zeros(),
        point: Point3::origin(),
    }; 5];
    for (place, z) in measured
        .iter_mut()
        .zip([-300.0, -290.0, -270.0, -260.0, -240.0])
    {
        place.point = Point3::new(z + 270.0, 20.0, z);
        place.angles = real.inverse(place.point).ok()?;
    }
    let longer = Parameter::of(Quantity::Lower, delta_kin::Arm::Second);
    let found = drawn.calibrate([longer], &measured).ok()?;
    holds((found.changes()[0] - 0.5).abs() < CLOSE_MM && found.rank() == 1)
}
