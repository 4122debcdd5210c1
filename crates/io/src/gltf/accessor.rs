//! Reads the elements of accessors.

use super::buffers::Buffers;
use super::document::{Accessor, Document};
use super::{fault, item};
use crate::error::ReadError;
use crate::faults::GltfFault;
use crate::number::Coordinate;
use crate::ply::{ByteOrder, Scalar};

/// The elements of an accessor: `width` numbers each.
pub(super) struct Elements<'a> {
    pub(super) count: u64,
    scalar: Scalar,
    normalized: bool,
    /// The bytes of all elements; `None` if all numbers are zero.
    base: Option<Strided<'a>>,
    sparse: Option<SparseElements<'a>>,
}

/// Replaced elements.
struct SparseElements<'a> {
    count: u64,
    index_scalar: Scalar,
    indices: Strided<'a>,
    values: Strided<'a>,
    /// Number of replacements that were used.
    next: u64,
}

/// Bytes of elements at equal distances.
#[derive(Clone, Copy)]
struct Strided<'a> {
    bytes: &'a [u8],
    stride: usize,
}

impl<'a> Strided<'a> {
    /// Returns the bytes from element `number` on.
    #[inline]
    fn element(&self, number: u64) -> &'a [u8] {
        let start = usize::try_from(number).map_or(usize::MAX, |n| n.saturating_mul(self.stride));
        self.bytes.get(start..).unwrap_or_default()
    }
}

/// Returns the elements of accessor `number`, which must have `width` numbers per element. `by` is
/// the place that names the accessor.
pub(super) fn elements<'a>(
    document: &'a Document,
    buffers: &'a Buffers,
    number: usize,
    width: usize,
    by: (&'static str, usize),
) -> Result<Elements<'a>, ReadError> {
    let accessor = item(&document.accessors, "accessor", number, by, buffers.name)?;
    let scalar =
        check_type(accessor, width).map_err(|f| fault(buffers.name, "accessor", number, f))?;
    let place = Placed {
        document,
        buffers,
        accessor: number,
    };
    let size = scalar.size() * width;
    let base = accessor
        .buffer_view
        .map(|view| place.strided(view, accessor.byte_offset, accessor.count, size, true));
    let sparse = accessor
        .sparse
        .as_ref()
        .map(|sparse| -> Result<_, ReadError> {
            let index_scalar = component(sparse.indices.component_type).unwrap_or(Scalar::U32);
            let (indices, values) = (&sparse.indices, &sparse.values);
            Ok(SparseElements {
                count: sparse.count,
                index_scalar,
                indices: place.strided(
                    indices.buffer_view,
                    indices.byte_offset,
                    sparse.count,
                    index_scalar.size(),
                    false,
                )?,
                values: place.strided(
                    values.buffer_view,
                    values.byte_offset,
                    sparse.count,
                    size,
                    false,
                )?,
                next: 0,
            })
        });
    Ok(Elements {
        count: accessor.count,
        scalar,
        normalized: accessor.normalized,
        base: base.transpose()?,
        sparse: sparse.transpose()?,
    })
}

/// Returns the type of the numbers, if the accessor suits positions (width 3) or indices (width 1).
fn check_type(accessor: &Accessor, width: usize) -> Result<Scalar, GltfFault> {
    let (kind, expected) = match width {
        3 => ("VEC3", "positions need VEC3 of numbers of 8, 16 or 32 bits"),
        _ => ("SCALAR", "indices need SCALAR of unsigned integers"),
    };
    let scalar = component(accessor.component_type);
    let suits = |scalar: &Scalar| match width {
        3 => *scalar != Scalar::U32,
        _ => matches!(scalar, Scalar::U8 | Scalar::U16 | Scalar::U32),
    };
    let scalar = scalar.filter(suits).filter(|_| accessor.kind == kind);
    scalar.ok_or_else(|| GltfFault::Type {
        found: format!(
            "{} of {}",
            crate::excerpt::shortened(&accessor.kind),
            accessor.component_type
        ),
        expected,
    })
}

/// Returns the type of numbers with this code of OpenGL.
fn component(code: u32) -> Option<Scalar> {
    Some(match code {
        5120 => Scalar::I8,
        5121 => Scalar::U8,
        5122 => Scalar::I16,
        5123 => Scalar::U16,
        5125 => Scalar::U32,
        5126 => Scalar::F32,
        _ => return None,
    })
}

/// An accessor of a document with its data.
struct Placed<'a> {
    document: &'a Document,
    buffers: &'a Buffers<'a>,
    accessor: usize,
}

impl<'a> Placed<'a> {
    /// Returns `count` elements of `size` bytes in a view, after checking that they are inside it.
    fn strided(
        &self,
        view: usize,
        offset: u64,
        count: u64,
        size: usize,
        may_have_stride: bool,
    ) -> Result<Strided<'a>, ReadError> {
        let bytes = self.buffers.view(self.document, view, self.accessor)?;
        let stride = self.document.buffer_views[view].byte_stride;
        let stride = stride.filter(|_| may_have_stride).unwrap_or(size as u64);
        let end = (count.saturating_sub(1).checked_mul(stride))
            .and_then(|last| last.checked_add(offset)?.checked_add(size as u64));
        let inside = end.filter(|&end| end <= bytes.len() as u64 && stride >= size as u64);
        if count == 0 {
            return Ok(Strided {
                bytes: &[],
                stride: size,
            });
        }
        let range = inside.and_then(|_| {
            let start = usize::try_from(offset).ok()?;
            bytes.get(start..).zip(usize::try_from(stride).ok())
        });
        let Some((bytes, stride)) = range else {
            let length = bytes.len() as u64;
            let end = end.map_or("2^64".to_owned(), |end| end.to_string());
            let fault_of = GltfFault::OutOfBuffer { end, length };
            return Err(fault(
                self.buffers.name,
                "accessor",
                self.accessor,
                fault_of,
            ));
        };
        Ok(Strided { bytes, stride })
    }
}

impl Elements<'_> {
    /// Returns whether the number of elements is not bounded by the size of a buffer.
    pub(super) fn is_unbounded(&self) -> bool {
        self.base.is_none()
    }

    /// Returns the bytes of element `number`; elements must be asked for in ascending order. `None`
    /// if all numbers are zero.
    fn bytes(&mut self, number: u64) -> Result<Option<&[u8]>, GltfFault> {
        if let Some(sparse) = &mut self.sparse
            && sparse.next < sparse.count
        {
            let bytes = sparse.indices.element(sparse.next);
            let index = sparse
                .index_scalar
                .whole(bytes, ByteOrder::Little)
                .flatten();
            let index = index
                .and_then(|index| u64::try_from(index).ok())
                .unwrap_or(u64::MAX);
            if index < number || index >= self.count {
                let count = self.count;
                return Err(GltfFault::SparseIndex { index, count });
            }
            if index == number {
                sparse.next += 1;
                return Ok(Some(sparse.values.element(sparse.next - 1)));
            }
        }
        Ok(self.base.as_ref().map(|base| base.element(number)))
    }

    /// Returns the position of element `number`; elements must be asked for in ascending order.
    #[inline]
    pub(super) fn position(&mut self, number: u64) -> Result<[Coordinate; 3], GltfFault> {
        let (scalar, normalized) = (self.scalar, self.normalized);
        let Some(bytes) = self.bytes(number)? else {
            return Ok([Coordinate::from(0.0_f32); 3]);
        };
        Ok([0, 1, 2].map(|i| {
            let bytes = bytes.get(i * scalar.size()..).unwrap_or_default();
            let value = scalar.coordinate(bytes, ByteOrder::Little);
            let value = value.unwrap_or(Coordinate::from(0.0_f32));
            match normalized {
                true => normalised(value.wide, scalar).into(),
                false => value,
            }
        }))
    }

    /// Returns the index in element `number`; elements must be asked for in ascending order.
    #[inline]
    pub(super) fn index(&mut self, number: u64) -> Result<i64, GltfFault> {
        let scalar = self.scalar;
        let Some(bytes) = self.bytes(number)? else {
            return Ok(0);
        };
        Ok(scalar
            .whole(bytes, ByteOrder::Little)
            .flatten()
            .unwrap_or(0))
    }
}

/// Returns the number from −1 to 1 that a normalised integer means. It has 32 bits, because the
/// integer has at most 16.
fn normalised(value: f64, scalar: Scalar) -> f32 {
    let largest = match scalar {
        Scalar::I8 => 127.0,
        Scalar::U8 => 255.0,
        Scalar::I16 => 32_767.0,
        Scalar::U16 => 65_535.0,
        _ => 1.0,
    };
    match scalar {
        Scalar::F32 => value as f32,
        _ => (value / largest).max(-1.0) as f32,
    }
}
