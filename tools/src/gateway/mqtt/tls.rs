//! TLS by rustls.

use alloc::sync::Arc;
use std::path::Path;

use anyhow::{Context as _, Result, anyhow};
use rumqttc::TlsConfiguration;
use rustls::{
    ClientConfig, RootCertStore,
    crypto::ring,
    pki_types::{CertificateDer, PrivateKeyDer, pem::PemObject as _},
};

use crate::gateway::config::Mqtt;

/// Who is trusted, and who this client is.
///
/// # Errors
/// A file that cannot be read or holds nothing of its kind.
pub(super) fn configuration(mqtt: &Mqtt) -> Result<TlsConfiguration> {
    let provider = Arc::new(ring::default_provider());
    let builder = ClientConfig::builder_with_provider(provider)
        .with_safe_default_protocol_versions()?
        .with_root_certificates(authorities(mqtt.ca_file.as_deref())?);
    let config = match (&mqtt.certificate_file, &mqtt.key_file) {
        (Some(certificate), Some(key_file)) => {
            let key = PrivateKeyDer::from_pem_file(key_file)
                .with_context(|| key_file.display().to_string())?;
            builder.with_client_auth_cert(certificates(certificate)?, key)?
        }
        _ => builder.with_no_client_auth(),
    };
    Ok(TlsConfiguration::Rustls(Arc::new(config)))
}

/// Those of the file, or else of the system.
fn authorities(file: Option<&Path>) -> Result<RootCertStore> {
    let certificates = match file {
        Some(file) => certificates(file)?,
        None => rustls_native_certs::load_native_certs().certs,
    };
    let mut authorities = RootCertStore::empty();
    authorities.add_parsable_certificates(certificates);
    if authorities.is_empty() {
        let place = file.map_or("the system".to_owned(), |file| file.display().to_string());
        return Err(anyhow!("{place}: no certificate authority"));
    }
    Ok(authorities)
}

fn certificates(file: &Path) -> Result<Vec<CertificateDer<'static>>> {
    let place = || file.display().to_string();
    let certificates: Vec<_> = CertificateDer::pem_file_iter(file)
        .with_context(place)?
        .collect::<Result<_, _>>()
        .with_context(place)?;
    if certificates.is_empty() {
        return Err(anyhow!("{}: no certificate", place()));
    }
    Ok(certificates)
}
