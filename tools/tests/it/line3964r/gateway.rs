//! `gateway` with a configuration that it refuses: one line, which names the place and the value.

use std::fs;
use std::net::TcpListener;

use tempfile::TempDir;

use super::program::{assert_refused, program, run};

const TCP: &str = "name = \"hall\"\n[tcp]\nlisten = \"127.0.0.1:0\"\n";
const MQTT: &str = "name = \"hall\"\n[mqtt]\nbroker = \"mqtts://h\"\n";
const LINE: &str = "[[line]]\nname = \"a\"\nport = \"/dev/null\"\npriority = \"low\"\n";

/// A configuration in a folder of its own.
struct Written(TempDir);

impl Written {
    fn new(config: &str) -> Self {
        let folder = TempDir::new().unwrap();
        fs::write(folder.path().join("gateway.toml"), config).unwrap();
        Self(folder)
    }

    fn path(&self, name: &str) -> String {
        self.0.path().join(name).display().to_string()
    }

    /// The error, in which `@` stands for the folder.
    fn is_refused(&self, error: &str) {
        let error = error.replace("@/", &self.path(""));
        let mut command = program("gateway");
        command.arg("--check").arg(self.path("gateway.toml"));
        assert_refused(&mut command, &format!("error: {error}"));
    }
}

#[test]
fn a_configuration_that_holds() {
    let written = Written::new(&format!("{TCP}{LINE}"));
    let mut command = program("gateway");
    let output = run(
        command.arg("--check").arg(written.path("gateway.toml")),
        b"",
    );
    assert!(output.status.success() && output.stderr.is_empty());
}

#[test]
fn wrong_values() {
    let long = "x".repeat(70_000);
    for (config, error) in [
        (
            format!("{TCP}[[line]\n"),
            "line 4, column 8: unclosed array table, expected `]`",
        ),
        (
            TCP.replace("\"hall\"", "5"),
            "line 1, column 8: invalid type: integer `5`, expected a string",
        ),
        (
            format!("{TCP}listen = \"127.0.0.1:1\"\n"),
            "line 4, column 1: duplicate key",
        ),
        (
            format!("{}{LINE}", TCP.replace("127.0.0.1:0", "localhost:4000")),
            "line 3, column 10: `localhost:4000` is not IP:PORT",
        ),
        (TCP.to_owned(), "line 1, column 1: missing field `line`"),
        (format!("line = []\n{TCP}"), "line 1, column 1: no [[line]]"),
        (
            format!("{TCP}{LINE}commands = \"16\"\n"),
            "line 8, column 12: invalid type: string \"16\", expected a nonzero u16",
        ),
        (
            format!("{TCP}{LINE}commands = 65536\n"),
            "line 8, column 12: invalid value: integer `65536`, expected a nonzero u16",
        ),
        (
            format!("{TCP}{}", LINE.replace("\"low\"", "\"middle\"")),
            "line 7, column 12: unknown variant `middle`, expected `low` or `high`",
        ),
        (
            format!("{TCP}{}", LINE.replace("/dev/null", "/dev/null?baud=fast")),
            "line 6, column 8: `/dev/null?baud=fast`: baud: `fast` is no number of bit/s",
        ),
        (
            format!("{TCP}{LINE}[[line.telegram]]\nname = \"w\"\nlength = 4097\n"),
            "line 8, column 1: telegram `w`: length 4097, at most 4096",
        ),
        (
            format!(
                "{TCP}{LINE}[[line.telegram]]\nname = \"w\"\nlength = 1\nstarts_with = \"41 42\"\n"
            ),
            "line 8, column 1: telegram `w`: begins with 2 bytes of 1",
        ),
        (
            format!(
                "{TCP}{LINE}[[line.telegram]]\nname = \"w\"\n[[line.telegram.field]]\nname = \"f\"\noffset = 4096\ntype = \"u8\"\n"
            ),
            "line 10, column 1: field `f`: ends at byte 4097 of 4096",
        ),
        (
            format!(
                "{TCP}{LINE}procedure = \"rk512\"\n[[line.area]]\nname = \"x\"\nstart = \"DB 1.0\"\nlength = 1\npoll_s = 1e19\n"
            ),
            "line 9, column 1: poll_s: 10000000000000000000 is no time in seconds, up to 1000000000",
        ),
        (
            format!("{MQTT}user = \"u\"\npassword = \"{long}\"\n{LINE}"),
            "line 2, column 1: mqtt: password: 70000 bytes, at most 65535",
        ),
        (
            format!("{MQTT}prefix = \"{long}\"\n{LINE}"),
            "line 4, column 10: a beginning of a topic of 70000 bytes, at most 256",
        ),
    ] {
        Written::new(&config).is_refused(&format!("@/gateway.toml: {error}"));
    }
}

#[test]
fn files_that_are_missing_or_hold_something_else() {
    let missing = "No such file or directory (os error 2)";
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("none.toml");
    let mut command = program("gateway");
    let error = format!("error: {}: {missing}", path.display());
    assert_refused(command.arg(path), &error);

    for (setting, error) in [
        (
            "ca_file = \"ca.pem\"",
            "@/ca.pem: I/O error: No such file or directory (os error 2)",
        ),
        (
            "ca_file = \"gateway.toml\"",
            "@/gateway.toml: no certificate",
        ),
        (
            "certificate_file = \"c.pem\"\nkey_file = \"k.pem\"",
            "@/k.pem: I/O error: No such file or directory (os error 2)",
        ),
        (
            "user = \"u\"\npassword_file = \"password\"",
            "@/password: No such file or directory (os error 2)",
        ),
    ] {
        Written::new(&format!("{MQTT}{setting}\n{LINE}")).is_refused(error);
    }
    let mqtt = MQTT.replace("mqtts", "mqtt");
    let written = Written::new(&format!(
        "{mqtt}user = \"u\"\npassword_file = \"p\"\n{LINE}"
    ));
    fs::write(written.path("p"), "x".repeat(70_000)).unwrap();
    written.is_refused("@/p: password: 70000 bytes, at most 65535");
}

#[test]
fn a_port_that_somebody_else_has() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let taken = listener.local_addr().unwrap();
    for section in ["tcp", "metrics"] {
        let other = format!("[{section}]\nlisten = \"{taken}\"\n");
        let config = match section {
            "tcp" => format!("name = \"hall\"\n{other}{LINE}"),
            _ => format!("{TCP}{other}{LINE}"),
        };
        let written = Written::new(&config);
        let mut command = program("gateway");
        command.arg(written.path("gateway.toml"));
        let error = format!("error: {taken}: Address already in use (os error 98)");
        assert_refused(&mut command, &error);
    }
}
