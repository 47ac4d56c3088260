//! NumPy arrays.
pub(crate) fn open_npy(
    f: &std::path::Path,
    _: &crate::ReadOptions,
) -> Result<crate::read::Raw, crate::RecordError> {
    Err(crate::RecordError::UnknownFormat {
        file: f.display().to_string(),
    })
}
pub(crate) use open_npy as open_npz;
