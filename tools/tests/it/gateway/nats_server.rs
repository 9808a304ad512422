//! Servers of NATS of the test's own.

use core::{net::Ipv4Addr, time::Duration};
use std::{
    env, fs,
    net::TcpStream,
    process::{Child, Command, Stdio},
    time::Instant,
};

use tempfile::TempDir;

use super::{
    broker::{PASSWORD, USER},
    listeners::free_ports,
    process::PATIENCE,
};

/// Attempts to find ports that nobody has.
const ATTEMPTS: u32 = 5;

/// One server, or three that know each other; what they hold outlives a kill.
pub(crate) struct Cluster {
    folder: TempDir,
    servers: Vec<Server>,
}

struct Server {
    port: u16,
    mqtt_port: u16,
    process: Option<Child>,
}

impl Cluster {
    /// `None`, and that is said, where there is no `nats-server`. `more` is for the configuration
    /// of each.
    pub(crate) async fn start(count: usize, more: &str) -> Option<Self> {
        let asked = Command::new("nats-server").arg("--version").output();
        if asked.is_err() {
            let required = env::var_os("POSE2PULSE_REQUIRE_NATS");
            assert!(required.is_none(), "there is no nats-server");
            eprintln!("skipped: there is no nats-server");
            return None;
        }
        for _ in 0..ATTEMPTS {
            let mut cluster = Self::configured(count, more);
            let mut are_up = true;
            for index in 0..count {
                are_up &= cluster.start_once(index).await;
            }
            if are_up {
                return Some(cluster);
            }
        }
        panic!("no ports for {count} servers");
    }

    fn configured(count: usize, more: &str) -> Self {
        let folder = TempDir::new().unwrap();
        let ports: Vec<[u16; 3]> = (0..count).map(|_| free_ports()).collect();
        let routes: Vec<_> = ports
            .iter()
            .map(|[_, _, port]| format!("\"nats://127.0.0.1:{port}\""))
            .collect();
        for (index, [port, mqtt_port, cluster_port]) in ports.iter().enumerate() {
            let shown = folder.path().display();
            let cluster = if count > 1 {
                let routes = routes.join(", ");
                format!(
                    "cluster {{ name: hall, listen: \"127.0.0.1:{cluster_port}\", routes: [{routes}] }}\n"
                )
            } else {
                format!("mqtt {{ listen: \"127.0.0.1:{mqtt_port}\" }}\n")
            };
            let settings = format!(
                "server_name: n{index}\nlisten: \"127.0.0.1:{port}\"\nmax_payload: 4000\n\
                 jetstream {{ store_dir: \"{shown}/n{index}\" }}\n\
                 authorization {{ user: {USER}, password: \"{PASSWORD}\" }}\n{cluster}{more}"
            );
            fs::write(folder.path().join(format!("n{index}.conf")), settings).unwrap();
        }
        let servers = ports.into_iter().map(|[port, mqtt_port, _]| Server {
            port,
            mqtt_port,
            process: None,
        });
        Self {
            folder,
            servers: servers.collect(),
        }
    }

    pub(crate) const fn len(&self) -> usize {
        self.servers.len()
    }

    /// Where clients connect.
    pub(crate) fn servers(&self) -> Vec<String> {
        let address = |server: &Server| format!("nats://127.0.0.1:{}", server.port);
        self.servers.iter().map(address).collect()
    }

    /// Where a single server speaks MQTT.
    pub(crate) fn mqtt_port(&self) -> u16 {
        self.servers[0].mqtt_port
    }

    /// SIGKILL.
    pub(crate) fn kill(&mut self, index: usize) {
        if let Some(mut process) = self.servers[index].process.take() {
            process.kill().unwrap();
            process.wait().unwrap();
        }
    }

    pub(crate) async fn start_again(&mut self, index: usize) {
        let begin = Instant::now();
        while !self.start_once(index).await {
            assert!(begin.elapsed() < PATIENCE, "a server does not start");
        }
    }

    /// Whether a server runs: not where somebody else has its port.
    async fn start_once(&mut self, index: usize) -> bool {
        let path = self.folder.path().join(format!("n{index}.conf"));
        let mut command = Command::new("nats-server");
        let spawned = command.arg("-c").arg(path).stderr(Stdio::null()).spawn();
        let mut process = spawned.unwrap();
        let address = (Ipv4Addr::LOCALHOST, self.servers[index].port);
        let begin = Instant::now();
        loop {
            if process.try_wait().unwrap().is_some() {
                return false;
            }
            if TcpStream::connect(address).is_ok() {
                self.servers[index].process = Some(process);
                return true;
            }
            assert!(begin.elapsed() < PATIENCE, "a server does not listen");
            tokio::time::sleep(Duration::from_millis(20)).await;
        }
    }
}

impl Drop for Cluster {
    fn drop(&mut self) {
        for index in 0..self.servers.len() {
            self.kill(index);
        }
    }
}
