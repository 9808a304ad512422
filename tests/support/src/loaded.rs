//! Machine files whose load is known, with something else in them, and what comes of it.

use serde_json::Value;

/// A number of a report, by its JSON pointer.
#[must_use]
pub fn number(report: &Value, at: &str) -> f64 {
    let number = report.pointer(at).and_then(Value::as_f64);
    number.unwrap_or_else(|| panic!("no number at {at}"))
}

/// The file without modes, with a pull-out curve in Nm over full steps a second, at multiples of a
/// speed, and without reserve.
#[must_use]
pub fn with_pull_out(file: &str, hz: f64, nm: impl Fn(f64) -> f64) -> String {
    let points = (0..=15).map(|n| hz * f64::from(n)).map(|hz| [hz, nm(hz)]);
    let (unshaped, _) = file.split_once("[mode").unwrap();
    let curve = format!("pull_out = {:?}\nreserve = 0.0", points.collect::<Vec<_>>());
    let machine = unshaped.replace("reserve = 0.3", &curve);
    assert_ne!(machine, unshaped);
    machine
}

/// Asserts that the file is refused with each text in place of another, for a reason that `error`
/// tells.
pub fn assert_refused_with(
    file: &str,
    changes: &[[&str; 3]],
    error: impl Fn(&str) -> Option<String>,
) {
    for [from, to, reason] in changes {
        let machine = file.replacen(&format!("\n{from}"), &format!("\n{to}"), 1);
        let machine = machine.replacen(from, to, usize::from(machine == file));
        let error = error(&machine).unwrap_or_else(|| panic!("{to} is accepted"));
        assert!(error.contains(reason), "{error}, not {reason}");
    }
    let (alone, _) = file.split_once("[torque]").unwrap();
    let error = error(alone).unwrap();
    assert_eq!(error, "[load] without [torque]: neither or both are needed");
}
