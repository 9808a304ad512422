//! Programs that would move X or Y otherwise than the stage can: refused, with the line.

use std::fs;

use tempfile::TempDir;

use crate::tools::artefacts::assert_refused;

#[test]
fn what_would_change_the_path_is_refused() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("bad.nc");
    for (program, reason) in [
        (
            "G1 X5",
            "no F before the first G1, G2 or G3: undefined feed rate (22)",
        ),
        (
            "G0 X5\nG1 X9 F0.5\nG20 X0 F0",
            "line 3: F0: 0 mm/min, not within",
        ),
        (
            "G0 Y G41 D",
            "G41: the tool's radius would move the path aside",
        ),
        (
            "G42.1 D3",
            "G42.1: the tool's radius would move the path aside",
        ),
        (
            "G68 X0 Y0 R45",
            "G68: scaling, mirroring, rotation and polar coordinates are not done",
        ),
        ("G51 P2", "G51: scaling"),
        ("G51.1 X0", "G51.1: scaling, mirroring"),
        ("G16", "G16: scaling, mirroring, rotation and polar"),
        ("G93", "G93: F would not be in mm/min"),
        ("G95", "G95: F would not be in mm/min"),
        ("G70", "G70: it is no unit everywhere: use G20 or G21"),
        ("G92 X5", "X is 0.000 mm here: its zero would move"),
        (
            "G0 X5\nG92",
            "line 2: X is 5.000 mm here: its zero would move",
        ),
        ("G52 Y5", "Y is 0.000 mm here: its zero would move"),
        ("G10 L2 P1 X5 Y5", "G10: it would move the zero of X and Y"),
        ("G10 L20 P1 Z5", "G10: it would move the zero of X and Y"),
        ("M206 X5", "M206: it would move the zero of X and Y"),
        ("M290 X1", "M290: it would move the zero of X and Y"),
        (
            "G54\nG0 X5\nG55\nG0 X5",
            "line 3: G55: a second work offset besides G54",
        ),
        (
            "G54.1 P1\nG54.1 P2",
            "line 2: G54.1 P2: a second work offset besides G54.1 P1",
        ),
        ("G30", "G30: the stage has no second reference point"),
        ("G30 X0", "G30: the stage has no second reference point"),
        (
            "G38.2 X5 F10",
            "G38.2: where probing ends is not known before",
        ),
        ("G5 X5 Y5 I1 J1 P1 Q1", "G5: splines are not done"),
        ("G65 P9000", "G65: a subprogram would move X and Y"),
        ("M98 P1000", "M98: a subprogram would move X and Y"),
        ("O100 sub", "O100: a subprogram would move X and Y"),
        ("M47", "M47: the program would be repeated"),
        ("M72", "M72: the modes to go back to are not known"),
        ("G76 X5", "G76: a cycle that moves the tool aside"),
        ("G81 X5 Z-1 R1 L3", "L3: a cycle that is repeated"),
        ("G91 G81 X5 Z-1 R1 K3", "K3: a cycle that is repeated"),
        ("G28 U0 W0", "U0: X or Y to some machines"),
        (
            "G0\nM62 P1 X5",
            "M62: whether X and Y are its own or a motion's is not known",
        ),
        (
            "G4 G1 X2 F60",
            "G4: X is its time to some machines, a motion to others",
        ),
        (
            "G0 X1 U5",
            "U5: X or Y to some machines, an axis of its own to others",
        ),
        ("G0 X1 V5", "V5: X or Y to some machines"),
        ("G2 I5 P2 F60", "P2: an arc of more than one turn"),
        ("G0 X1 P5", "P5: no word of this stage"),
        ("G0 X1 Q5", "Q5: no word of this stage"),
        ("L5", "L5: no word of this stage"),
        ("G1 X5 K1 F60", "K on a straight motion"),
        ("G90 G91 X5", "G91: a second distance mode"),
        ("G20 G21", "G21: a second unit"),
        ("G0 G28 X5", "G28: a second motion"),
        ("G123 X5", "G123: no code of this stage"),
        ("G1.5 X5", "G1.5: no code of this stage"),
        ("G-1 X5", "G-1: no code of this stage"),
        ("M3.1", "M3.1: no code of this stage"),
        ("G", "column 1: G without a number"),
        ("G80\nX5", "line 2: no G0, G1, G2 or G3 before"),
        ("G0 X5 Y", "column 7: Y without a number"),
        ("G0 X-", "column 4: \"X-\": no number"),
        ("G0 X1e-5", "column 4: X1e-5: a number has no exponent"),
        ("G0 X1E3", "column 4: X1E3: a number has no exponent"),
        ("G0 X1,5", "column 6: ',' begins no word"),
        ("G0 X1.2.3", "column 8: '.' begins no word"),
        ("G0 X1 2", "column 7: '2' begins no word"),
        (
            "G0 X#1",
            "column 5: '#': parameters and expressions are not computed here",
        ),
        ("#1=5", "column 1: '#': parameters"),
        ("G0 X[1+2]", "column 5: '[': parameters"),
        ("o<part> call", "column 2: '<': parameters"),
        ("$H", "column 1: '$' begins no word"),
        ("G0 X5)", "column 6: ')' begins no word"),
        ("N1 G1 X10 F60*81", "checksum \"81\", the line has"),
        ("N1 G1 X10 F60*", "checksum \"\", the line has"),
        ("G90.1 G3 X5 I5 F60", "an arc after G90.1 without I and J"),
        ("G3 X5 I5 R5 F60", "an arc with both R and I or J"),
        (
            "G18 G3 X2 Z-2 I2 F60",
            "an arc in a plane with Z, and no Z before",
        ),
        (
            "G0 Z0\nG18 G3 X0 Z0 I2 F60",
            "seen from above, the arc goes 4.000 mm beyond its ends",
        ),
        (
            "G0 Z0\nG19 G2 Y2 Z-2 J2 K0 F60",
            "seen from above, the arc goes 2.000 mm beyond its ends",
        ),
        (
            "G0 Z0\nG18 G3 X2 Y1 Z-2 I2 F60",
            "a helix about X or Y is no line seen from above",
        ),
        (
            "G0 Z9\nG1 E5\nM104",
            "bad.nc: nothing moves: line 1: Z: passed over",
        ),
        ("%", "bad.nc: nothing moves"),
        ("G0 X5 M2", "a motion with the end of the program"),
    ] {
        fs::write(&file, program).unwrap();
        assert_refused("stage", &["--gcode", file.to_str().unwrap()], reason);
    }
}
