//! Who may ask: the page that this program opened, nobody else on the machine or in the browser.

use hyper::Uri;
use hyper::header::{HOST, HeaderMap, HeaderName, ORIGIN};

/// Header with the token.
pub(super) const TOKEN: HeaderName = HeaderName::from_static("x-hertzchain-token");

/// Header by which browsers report from where a request comes.
const SITE: HeaderName = HeaderName::from_static("sec-fetch-site");

/// What requests must have.
pub(super) struct Guard {
    port: u16,
    token: String,
}

impl Guard {
    /// Returns a guard with a fresh token of 192 random bits.
    ///
    /// # Errors
    /// A system without random numbers.
    pub(super) fn new(port: u16) -> Result<Self, getrandom::Error> {
        let mut bytes = [0; 24];
        getrandom::fill(&mut bytes)?;
        let token = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
        Ok(Self { port, token })
    }

    /// Returns the address that opens the page.
    pub(super) fn address(&self) -> String {
        format!("http://127.0.0.1:{}/?token={}", self.port, self.token)
    }

    fn names(&self) -> [String; 2] {
        ["127.0.0.1", "localhost"].map(|host| format!("{host}:{}", self.port))
    }

    /// Returns whether a request was addressed to this server by a page of its own: a name that
    /// another site made point here (DNS rebinding) is another host.
    pub(super) fn is_local(&self, headers: &HeaderMap) -> bool {
        let text = |name| headers.get(name).and_then(|value| value.to_str().ok());
        let host = text(&HOST).is_some_and(|host| self.names().iter().any(|name| name == host));
        let own = |origin: &str| self.names().iter().any(|name| origin == format!("http://{name}"));
        let origin = headers.get(&ORIGIN).is_none() || text(&ORIGIN).is_some_and(own);
        let site = text(&SITE).is_none_or(|site| matches!(site, "same-origin" | "none"));
        host && origin && site
    }

    /// Returns whether a request has the token in its header.
    pub(super) fn has_token(&self, headers: &HeaderMap) -> bool {
        let token = headers.get(&TOKEN).map(|value| value.as_bytes());
        token.is_some_and(|token| self.is_token(token))
    }

    /// Returns whether an address has the token in its query.
    pub(super) fn opens(&self, uri: &Uri) -> bool {
        let mut words = uri.query().unwrap_or_default().split('&');
        words.any(|word| {
            let token = word.strip_prefix("token=");
            token.is_some_and(|token| self.is_token(token.as_bytes()))
        })
    }

    /// Compares in a time that does not depend on where both differ.
    fn is_token(&self, given: &[u8]) -> bool {
        let own = self.token.as_bytes();
        let differences = own.iter().zip(given).fold(0, |sum, (a, b)| sum | (a ^ b));
        own.len() == given.len() && differences == 0
    }
}
