//! A mosquitto of the test's own.

use core::{net::Ipv4Addr, time::Duration};
use std::{
    env, fs,
    net::TcpStream,
    path::PathBuf,
    process::{Child, Command, Stdio},
    thread,
};

use rcgen::{BasicConstraints, CertificateParams, IsCa, Issuer, KeyPair};
use tempfile::TempDir;

use super::listeners::free_ports;

pub(crate) const USER: &str = "plant";
pub(crate) const PASSWORD: &str = "not a secret";

/// Where Debian has it, which is not in everybody's path.
const PROGRAMS: [&str; 2] = ["/usr/sbin/mosquitto", "mosquitto"];

/// A broker with a password, on a port of this machine; what it holds outlives a stop.
pub(crate) struct Broker {
    folder: TempDir,
    pub(crate) port: u16,
    pub(crate) tls_port: u16,
    process: Option<Child>,
}

impl Broker {
    pub(crate) fn start() -> Option<Self> {
        Self::start_with("", None)
    }

    /// With more settings, and a list of what its user may do.
    pub(crate) fn start_with(more: &str, acl: Option<&str>) -> Option<Self> {
        if program().is_none() {
            let required = env::var_os("POSE2PULSE_REQUIRE_MOSQUITTO");
            assert!(required.is_none(), "there is no mosquitto");
            eprintln!("skipped: there is no mosquitto");
            return None;
        }
        let folder = TempDir::new().unwrap();
        let path = folder.path();
        let [port, tls_port] = free_ports();
        let passwords = path.join("passwords");
        let made = Command::new("mosquitto_passwd")
            .args(["-b", "-c"])
            .arg(&passwords)
            .args([USER, PASSWORD])
            .output()
            .unwrap();
        assert!(made.status.success(), "{made:?}");
        certificates(&folder);
        let shown = path.display();
        let acl_file = acl.map_or(String::new(), |acl| {
            fs::write(path.join("acl"), acl).unwrap();
            format!("acl_file {shown}/acl")
        });
        let settings = format!(
            "user root
{more}{acl_file}
per_listener_settings false
allow_anonymous false
password_file {shown}/passwords
persistence true
persistence_location {shown}/
max_queued_messages 0
listener {port} 127.0.0.1
listener {tls_port} 127.0.0.1
certfile {shown}/broker.pem
keyfile {shown}/broker.key
"
        );
        fs::write(path.join("mosquitto.conf"), settings).unwrap();
        let mut broker = Self {
            folder,
            port,
            tls_port,
            process: None,
        };
        broker.start_again();
        Some(broker)
    }

    pub(crate) fn start_again(&mut self) {
        let mut process = Command::new(program().unwrap())
            .arg("-c")
            .arg(self.folder.path().join("mosquitto.conf"))
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        while TcpStream::connect((Ipv4Addr::LOCALHOST, self.port)).is_err() {
            let ended = process.try_wait().unwrap();
            assert!(ended.is_none(), "mosquitto: {ended:?}");
            thread::sleep(Duration::from_millis(10));
        }
        self.process = Some(process);
    }

    /// As an administrator stops it: it saves what it holds.
    pub(crate) fn stop(&mut self) {
        if let Some(mut process) = self.process.take() {
            terminate(&process);
            process.wait().unwrap();
        }
    }

    /// Stops answering, with all connections open.
    pub(crate) fn hang(&self) {
        self.signal("-STOP");
    }

    /// After it has hung.
    pub(crate) fn go_on(&self) {
        self.signal("-CONT");
    }

    fn signal(&self, name: &str) {
        signal(self.process.as_ref().unwrap(), name);
    }

    /// The authority that signed the broker's certificate.
    pub(crate) fn authority(&self) -> PathBuf {
        self.folder.path().join("authority.pem")
    }

    /// One that did not.
    pub(crate) fn other_authority(&self) -> PathBuf {
        self.folder.path().join("other.pem")
    }
}

impl Drop for Broker {
    fn drop(&mut self) {
        self.stop();
    }
}

/// SIGTERM.
pub(crate) fn terminate(process: &Child) {
    signal(process, "-TERM");
}

pub(crate) fn signal(process: &Child, name: &str) {
    let id = process.id().to_string();
    let sent = Command::new("kill").args([name, &id]).status().unwrap();
    assert!(sent.success());
}

fn program() -> Option<&'static str> {
    PROGRAMS.into_iter().find(|program| {
        let asked = Command::new(program)
            .arg("-h")
            .stdout(Stdio::null())
            .status();
        asked.is_ok()
    })
}

/// An authority, the broker's certificate by it, and another authority.
fn certificates(folder: &TempDir) {
    let authority = |name: &str| {
        let mut parameters = CertificateParams::new([]).unwrap();
        parameters.is_ca = IsCa::Ca(BasicConstraints::Unconstrained);
        let key = KeyPair::generate().unwrap();
        let certificate = parameters.self_signed(&key).unwrap();
        fs::write(folder.path().join(name), certificate.pem()).unwrap();
        Issuer::new(parameters, key)
    };
    let issuer = authority("authority.pem");
    authority("other.pem");
    let key = KeyPair::generate().unwrap();
    let parameters = CertificateParams::new(["127.0.0.1".to_owned()]).unwrap();
    let certificate = parameters.signed_by(&key, &issuer).unwrap();
    fs::write(folder.path().join("broker.pem"), certificate.pem()).unwrap();
    fs::write(folder.path().join("broker.key"), key.serialize_pem()).unwrap();
}
