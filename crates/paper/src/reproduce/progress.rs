//! How far a long computation is.

/// Is notified how far a long computation is; may be called from any thread.
pub trait Progress: Sync {
    /// A stage of so many steps begins.
    fn begin(&self, stage: &str, steps: u64);
    /// One step of the stage is done.
    fn advance(&self);
    /// Something to know before a stage begins.
    fn note(&self, _text: &str) {}
}

/// Reports nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Progress for Silent {
    fn begin(&self, _stage: &str, _steps: u64) {}
    fn advance(&self) {}
}
