//! An upright arm that carries 2 kg round a triangle without end, as fast as its motors can, until
//! someone holds it, and then at half the feed: no motor gives more torque than it has.
//!
//! `cargo run -p scara-kin --features path-timing --example hold_a_load`

use core::error::Error;

use path_timing::{AxisLimits, Curve, Knot, Span, TorqueCurve, TorqueLimits, TorqueLookAhead};
use scara_kin::{Arm, ArmMasses, Elbow, JointDrive, LinkMass};

const CORNERS: [[f64; 2]; 3] = [[250.0, 350.0], [350.0, -100.0], [150.0, 200.0]]; // mm

fn main() -> Result<(), Box<dyn Error>> {
    let arm = Arm::new(300.0, 300.0)?; // mm
    let link = LinkMass {
        mass_kg: 2.5,
        centre_m: 0.14,
        inertia_kg_m2: 0.03,
    };
    let drive = JointDrive {
        rotor_kg_m2: 0.08,
        viscous_nm_s: 0.3,
        coulomb_nm: 0.8,
    };
    let masses = ArmMasses {
        upper: link,
        fore: link,
        payload_kg: 2.0,
        shoulder: drive,
        elbow: drive,
        gravity_m_s2: 9.81,
    };
    let torque = TorqueLimits {
        dynamics: arm.dynamics(1e-3, masses)?,
        motors: [
            TorqueCurve::holding(60.0, 3.0, 30.0)?, // Nm, rad/s, rad/s
            TorqueCurve::holding(25.0, 4.0, 30.0)?,
        ],
    };
    let sides = CORNERS.iter().zip(CORNERS.iter().cycle().skip(1)).cycle();
    let sides = sides.map_while(|(from, to)| {
        let side = Curve::line(*from, *to).ok()?;
        arm.path(side, Elbow::Right).ok()
    });
    let joint = AxisLimits {
        speed: 30.0,
        acceleration: 1000.0,
        jerk: None,
    }; // besides, rad, s
    let mut window = [Knot::default(); 256];
    let mut motion: TorqueLookAhead<'_, _, _, _, _> =
        torque.look_ahead(sides, [joint; 2], |_| Ok(60), &mut window)?;

    let mut used = 0.0_f64;
    let mut before = None;
    for number in 0..500 {
        match number {
            200 => motion.stop(),
            300 => motion.set_feed(0.5)?,
            _ => {}
        }
        let Some(row) = motion.next_row()? else {
            continue; // held
        };
        if let Some(from) = before.replace(row) {
            let rows = [from, row];
            used = used.max(torque.utilisation(&Span { s: [0.0; 2], rows }));
        }
    }
    let last = before.ok_or("no row")?;
    println!(
        "side {}, {:.3} s: at most {:.2} % of a torque used",
        last.leg,
        last.time_s,
        100.0 * used
    );
    Ok(())
}
