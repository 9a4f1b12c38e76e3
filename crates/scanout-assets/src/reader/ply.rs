//! Not yet.

use super::Source;
use crate::error::{At, LoadError};
use crate::raw::Raw;

pub(crate) fn read(source: &Source<'_>) -> Result<Raw, LoadError> {
    Err(LoadError::unsupported(source.name, At::File, "this format is not read yet"))
}
