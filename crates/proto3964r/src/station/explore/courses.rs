//! The explorations: which settings, which faults, and what must hold.

use super::*;

/// Two or three attempts keep the graph small and exercise the last attempt too.
fn scope(priorities: [Priority; 2], attempts: u8, payloads: [u8; 2], faults: u8) -> Scope {
    let config = |priority| Config {
        connection_attempts: attempts,
        transmission_attempts: attempts,
        nak_at_startup: false,
        ..Config::siemens_3964r(priority, Line::Instant)
    };
    Scope {
        configs: priorities.map(config),
        payloads,
        faults,
        slow_user: false,
        damaged_to: &[STX, ETX, DLE, NAK, 0x41],
    }
}

const DISTINCT: [Priority; 2] = [Priority::High, Priority::Low];
const PAYLOADS: [[u8; 2]; 3] = [[DLE, ETX], [STX, NAK], [0x41, DLE]];

fn report(name: &str, findings: &Findings) {
    println!("{name}: {findings:?}");
}

#[test]
fn without_faults_everything_arrives_once() {
    for payloads in PAYLOADS {
        let findings = explore(&scope(DISTINCT, 2, payloads, 0));
        report("no fault", &findings);
        assert!(findings.worlds > 100);
        let Findings {
            with_failure,
            with_repeat,
            forged,
            lost,
            ..
        } = findings;
        assert_eq!((with_failure, with_repeat, forged, lost), (0, 0, 0, 0));
    }
}

/// Characters take their time, so that some come too soon to be answers.
#[test]
fn on_a_paced_line_nothing_is_lost() {
    for payloads in PAYLOADS {
        let findings = explore(&scope(DISTINCT, 2, payloads, 0).paced());
        report("paced, no fault", &findings);
        let Findings {
            with_failure,
            with_repeat,
            forged,
            lost,
            ..
        } = findings;
        assert_eq!((with_failure, with_repeat, forged, lost), (0, 0, 0, 0));
    }
    for payloads in PAYLOADS {
        let findings = explore(&scope(DISTINCT, 5, payloads, 1).paced());
        report("paced, one fault", &findings);
        assert_eq!((findings.with_failure, findings.forged), (0, 0));
    }
    let findings = explore(&scope(DISTINCT, 2, [DLE, 0x41], 2).paced());
    report("paced, two faults", &findings);
    assert!(findings.ends > 0);
}

/// One fault anywhere: nothing fails, nothing is forged.
#[test]
fn one_fault_is_survived() {
    for payloads in PAYLOADS {
        let findings = explore(&scope(DISTINCT, 5, payloads, 1));
        report("one fault", &findings);
        assert_eq!((findings.with_failure, findings.forged), (0, 0));
    }
}

/// Two faults: every course still ends, with every job ended once.
#[test]
fn two_faults_leave_nobody_stuck() {
    let findings = explore(&scope(DISTINCT, 2, [DLE, 0x41], 2));
    report("two faults", &findings);
    assert!(findings.ends > 0);
}

/// A user who leaves the receive buffer in use makes the partner wait, and at worst fail.
#[test]
fn a_slow_user_leaves_nobody_stuck() {
    for faults in [0, 1] {
        let scope = Scope {
            slow_user: true,
            ..scope(DISTINCT, 3, [DLE, ETX], faults)
        };
        let findings = explore(&scope);
        report("slow user", &findings);
        assert_eq!(findings.forged, 0);
    }
}

/// A sender gets success reported only when the receiver's user has accepted, whoever accepts,
/// refuses or forgets, and whatever the line does; and nobody gets stuck.
#[test]
fn what_is_held_is_acknowledged_by_its_user_alone() {
    for payloads in PAYLOADS {
        let findings = explore(&scope(DISTINCT, 2, payloads, 0).held());
        report("held, no fault", &findings);
        assert_eq!((findings.forged, findings.lost), (0, 0));
        assert!(findings.with_failure > 0, "who refuses is among the users");
        assert_eq!(findings.with_repeat, 0);
    }
    for faults in [0, 1] {
        let findings = explore(&scope(DISTINCT, 2, [DLE, 0x41], faults).held().paced());
        report("held, paced", &findings);
        assert_eq!((findings.forged, findings.ends > 0), (0, true));
    }
    let slow = Scope {
        slow_user: true,
        ..scope(DISTINCT, 2, [DLE, ETX], 1).held()
    };
    let findings = explore(&slow);
    report("held, slow user, one fault", &findings);
    assert_eq!((findings.forged, findings.ends > 0), (0, true));
    for priority in [Priority::High, Priority::Low] {
        let findings = explore(&scope([priority; 2], 2, [DLE, 0x41], 0).held());
        report("held, equal priorities", &findings);
        assert!(findings.ends > 0);
    }
}

/// Equal priorities, with which the procedure cannot always succeed, still end.
#[test]
fn equal_priorities_end() {
    for priority in [Priority::High, Priority::Low] {
        let findings = explore(&scope([priority; 2], 3, [DLE, 0x41], 1));
        report("equal priorities, one fault", &findings);
        assert!(
            findings.with_failure > 0,
            "a meeting of equals is among the courses"
        );
    }
}

/// Three faults. A DLE that comes late twice can then acknowledge a block that did not arrive,
/// which is counted. `cargo test --release -p proto3964r -- --ignored --nocapture explore`
#[test]
#[ignore = "minutes in a debug build, 17 s in a release build: `.ci/nightly` runs it"]
fn three_faults_leave_nobody_stuck() {
    let findings = explore(&scope(DISTINCT, 2, [DLE, 0x41], 3));
    report("three faults", &findings);
    assert!(findings.ends > 0);
}
