//! TLS by rustls.

use alloc::sync::Arc;
use std::path::Path;

use anyhow::{Context as _, Result, anyhow};
use rustls::{
    ClientConfig, RootCertStore,
    crypto::ring,
    pki_types::{CertificateDer, PrivateKeyDer, pem::PemObject as _},
};

/// Who is trusted, and who this client is: files in PEM.
pub(crate) struct Files<'f> {
    /// Without it, the system's authorities.
    pub(crate) authorities: Option<&'f Path>,
    /// Certificate and key.
    pub(crate) identity: Option<(&'f Path, &'f Path)>,
}

/// The settings of a client.
///
/// # Errors
/// A file that cannot be read or holds nothing of its kind.
pub(crate) fn client(files: Files<'_>) -> Result<ClientConfig> {
    let provider = Arc::new(ring::default_provider());
    let builder = ClientConfig::builder_with_provider(provider)
        .with_safe_default_protocol_versions()?
        .with_root_certificates(authorities(files.authorities)?);
    Ok(match files.identity {
        Some((certificate, key_file)) => {
            let key = PrivateKeyDer::from_pem_file(key_file)
                .with_context(|| key_file.display().to_string())?;
            builder.with_client_auth_cert(certificates(certificate)?, key)?
        }
        None => builder.with_no_client_auth(),
    })
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
