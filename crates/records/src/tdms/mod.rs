//! Columns of numbers as text.
pub(crate) fn open(
    f: &std::path::Path,
    _: &crate::ReadOptions,
) -> Result<crate::read::Raw, crate::RecordError> {
    Err(crate::RecordError::UnknownFormat {
        file: f.display().to_string(),
    })
}
