//! Accessors: typed, bounds-checked views into the buffers.

use super::schema::{Accessor, Document};
use crate::error::LoadError;
use crate::reader::Source;
use std::borrow::Cow;

/// The document with its buffers.
pub(super) struct Access<'a> {
    pub document: &'a Document,
    pub buffers: &'a [Cow<'a, [u8]>],
    pub source: &'a Source<'a>,
}

/// A run of elements in bytes.
struct Run<'a> {
    bytes: &'a [u8],
    stride: usize,
    component: u32,
    normalized: bool,
}

impl Access<'_> {
    fn fail(&self, what: impl Into<String>) -> LoadError {
        super::malformed(self.source, what)
    }

    /// The bytes of a buffer view.
    pub(super) fn view(&self, index: usize) -> Result<&[u8], LoadError> {
        let bytes = self.document.buffer_views.get(index).and_then(|view| {
            let end = view.byte_offset.checked_add(view.byte_length)?;
            self.buffers.get(view.buffer)?.get(view.byte_offset..end)
        });
        bytes.ok_or_else(|| {
            self.fail(format!(
                "buffer view {index} is missing or outside its buffer; is the file complete?"
            ))
        })
    }

    /// Elements of up to four components as `f64`, at least `width` of them; missing ones are 0. Normalised integers and
    /// integer types are converted as the specification says.
    pub(super) fn vectors(&self, index: usize, width: usize) -> Result<Vec<[f64; 4]>, LoadError> {
        let accessor = self.accessor(index)?;
        let components = match accessor.kind.as_str() {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 0,
        };
        if components < width {
            return Err(self.fail(format!("accessor {index} has the wrong type")));
        }
        let size = component_size(accessor.component_type)
            .ok_or_else(|| self.fail(format!("accessor {index} has an unknown component type")))?;
        let mut values = vec![[0.0; 4]; accessor.count];
        if let Some(view) = accessor.buffer_view {
            let run =
                self.run(accessor, view, accessor.byte_offset, size * components, accessor.count)?;
            for (i, value) in values.iter_mut().enumerate() {
                *value = run.element(i, components, size);
            }
        }
        if let Some(sparse) = &accessor.sparse {
            if sparse.count > accessor.count {
                return Err(self.fail(format!("accessor {index} has too many sparse entries")));
            }
            let wide = component_size(sparse.indices.component_type)
                .ok_or_else(|| self.fail(format!("accessor {index} has unknown sparse indices")))?;
            let mut places = self.run(
                accessor,
                sparse.indices.buffer_view,
                sparse.indices.byte_offset,
                wide,
                sparse.count,
            )?;
            places.component = sparse.indices.component_type;
            places.normalized = false;
            let replacements = self.run(
                accessor,
                sparse.values.buffer_view,
                sparse.values.byte_offset,
                size * components,
                sparse.count,
            )?;
            for i in 0..sparse.count {
                let place = places.element(i, 1, wide)[0];
                let slot = values.get_mut(place as usize).filter(|_| place >= 0.0);
                *slot.ok_or_else(|| {
                    self.fail(format!("accessor {index}: sparse index {place} is outside"))
                })? = replacements.element(i, components, size);
            }
        }
        Ok(values)
    }

    /// Indices, all less than `count`.
    pub(super) fn indices(&self, index: usize, count: usize) -> Result<Vec<u32>, LoadError> {
        let accessor = self.accessor(index)?;
        if !matches!(accessor.component_type, 5121 | 5123 | 5125) {
            return Err(self.fail(format!("accessor {index}: indices must be unsigned integers")));
        }
        if accessor.kind != "SCALAR" || accessor.normalized {
            return Err(self.fail(format!("accessor {index} has the wrong type")));
        }
        self.vectors(index, 1)?
            .into_iter()
            .map(|value| {
                // 0xffffffff and its like are outside any mesh.
                let wanted = value[0];
                if wanted < count as f64 {
                    Ok(wanted as u32)
                } else {
                    Err(self.fail(format!(
                        "vertex {wanted} of {count} is asked for; export the file again"
                    )))
                }
            })
            .collect()
    }

    fn accessor(&self, index: usize) -> Result<&Accessor, LoadError> {
        let accessor = self
            .document
            .accessors
            .get(index)
            .ok_or_else(|| self.fail(format!("accessor {index} is asked for and missing")))?;
        if accessor.count > self.source.limits.elements as usize {
            return Err(LoadError::too_large(
                self.source.name,
                format!("accessor {index} has {} elements; simplify the mesh", accessor.count),
            ));
        }
        Ok(accessor)
    }

    /// `count` elements of `size` bytes in a view, checked before anything is read.
    fn run(
        &self,
        accessor: &Accessor,
        view: usize,
        offset: usize,
        size: usize,
        count: usize,
    ) -> Result<Run<'_>, LoadError> {
        let bytes = self.view(view)?;
        let stride = self.document.buffer_views[view].byte_stride.unwrap_or(size);
        let end = count
            .checked_sub(1)
            .map_or(Some(0), |last| last.checked_mul(stride)?.checked_add(size))
            .and_then(|length| length.checked_add(offset));
        let fits = end.is_some_and(|end| end <= bytes.len());
        if !fits || offset > bytes.len() || stride < size {
            return Err(self.fail(format!("{count} elements don't fit into buffer view {view}")));
        }
        Ok(Run {
            bytes: &bytes[offset..],
            stride,
            component: accessor.component_type,
            normalized: accessor.normalized,
        })
    }
}

impl Run<'_> {
    /// `components` numbers of `size` bytes.
    fn element(&self, index: usize, components: usize, size: usize) -> [f64; 4] {
        let bytes = &self.bytes[index * self.stride..];
        std::array::from_fn(|i| {
            if i >= components {
                return 0.0;
            }
            let mut b = [0; 4];
            b[..size].copy_from_slice(&bytes[i * size..(i + 1) * size]);
            let word = u32::from_le_bytes(b);
            let (value, most) = match self.component {
                5120 => (f64::from(b[0] as i8), 127.0),
                5121 => (f64::from(b[0]), 255.0),
                5122 => (f64::from(word as i16), 32767.0),
                5123 => (f64::from(word), 65535.0),
                5125 => (f64::from(word), 1.0),
                _ => (f64::from(f32::from_bits(word)), 1.0),
            };
            if self.normalized { (value / most).max(-1.0) } else { value }
        })
    }
}

fn component_size(component: u32) -> Option<usize> {
    match component {
        5120 | 5121 => Some(1),
        5122 | 5123 => Some(2),
        5125 | 5126 => Some(4),
        _ => None,
    }
}
