//! The types of numbers in PLY files.

use crate::number::Coordinate;

/// A type of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

/// The order of the bytes of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ByteOrder {
    Little,
    Big,
}

impl Scalar {
    /// Returns the type with this name in a header; most types have two names. The types of 64 bits
    /// are an extension. `long` has 4 or 8 bytes, so it is not a type.
    pub(crate) fn from_name(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"int64" => Self::I64,
            b"uint64" => Self::U64,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    /// Returns the number of bytes of a value.
    pub(crate) const fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// Returns whether the values have fractions.
    pub(crate) const fn is_float(self) -> bool {
        matches!(self, Self::F32 | Self::F64)
    }

    /// Returns the value that `bytes` begins with, as a coordinate; `None` if there are too few
    /// bytes.
    #[inline]
    pub(crate) fn coordinate(self, bytes: &[u8], order: ByteOrder) -> Option<Coordinate> {
        Some(match self {
            Self::F32 => f32::from_bits(u32::from_bytes(bytes, order)?).into(),
            Self::F64 => f64::from_bits(u64::from_bytes(bytes, order)?).into(),
            Self::U64 => (u64::from_bytes(bytes, order)? as f64).into(),
            // Whole numbers above 53 bits are rounded.
            _ => (self.whole(bytes, order)?? as f64).into(),
        })
    }

    /// Returns the value that `bytes` begins with, as a whole number: `None` if there are too few
    /// bytes, and `Some(None)` if it has a fraction or is very large.
    #[inline]
    pub(crate) fn whole(self, bytes: &[u8], order: ByteOrder) -> Option<Option<i64>> {
        Some(Some(match self {
            Self::I8 => i64::from(u8::from_bytes(bytes, order)? as i8),
            Self::U8 => i64::from(u8::from_bytes(bytes, order)?),
            Self::I16 => i64::from(u16::from_bytes(bytes, order)? as i16),
            Self::U16 => i64::from(u16::from_bytes(bytes, order)?),
            Self::I32 => i64::from(u32::from_bytes(bytes, order)? as i32),
            Self::U32 => i64::from(u32::from_bytes(bytes, order)?),
            Self::I64 => u64::from_bytes(bytes, order)? as i64,
            Self::U64 => return Some(i64::try_from(u64::from_bytes(bytes, order)?).ok()),
            Self::F32 | Self::F64 => {
                let value = self.coordinate(bytes, order)?.wide;
                let whole = value as i64;
                return Some((whole as f64 == value).then_some(whole));
            }
        }))
    }
}

/// A number made of bytes.
trait FromBytes: Sized {
    /// Returns the number that `bytes` begins with.
    fn from_bytes(bytes: &[u8], order: ByteOrder) -> Option<Self>;
}

macro_rules! from_bytes {
    ($($number:ty)*) => {$(
        impl FromBytes for $number {
            #[inline]
            fn from_bytes(bytes: &[u8], order: ByteOrder) -> Option<Self> {
                let bytes = *bytes.first_chunk()?;
                Some(match order {
                    ByteOrder::Little => Self::from_le_bytes(bytes),
                    ByteOrder::Big => Self::from_be_bytes(bytes),
                })
            }
        }
    )*};
}

from_bytes!(u8 u16 u32 u64);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_of_all_types_are_decoded() {
        let both = |scalar: Scalar, mut bytes: Vec<u8>, expected: f64| {
            for order in [ByteOrder::Big, ByteOrder::Little] {
                let found = scalar.coordinate(&bytes, order).expect("enough bytes");
                assert_eq!(found.wide, expected, "{scalar:?}");
                let whole = scalar.whole(&bytes, order).expect("enough bytes");
                assert_eq!(whole, (expected.fract() == 0.0).then_some(expected as i64));
                assert!(scalar.coordinate(&bytes[1..], order).is_none());
                assert!(scalar.whole(&bytes[1..], order).is_none());
                bytes.reverse();
            }
        };
        both(Scalar::I8, vec![0x80], -128.0);
        both(Scalar::U8, vec![0x80], 128.0);
        both(Scalar::I16, vec![0xFF, 0xFE], -2.0);
        both(Scalar::U16, vec![0xFF, 0xFE], 65_534.0);
        both(Scalar::I32, vec![0x80, 0, 0, 1], -2_147_483_647.0);
        both(Scalar::U32, vec![0x80, 0, 0, 1], 2_147_483_649.0);
        both(
            Scalar::I64,
            vec![0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFE],
            -2.0,
        );
        both(Scalar::U64, vec![0, 0, 0, 1, 0, 0, 0, 1], 4_294_967_297.0);
        both(Scalar::F32, 1.5_f32.to_be_bytes().to_vec(), 1.5);
        both(Scalar::F64, (-7.0_f64).to_be_bytes().to_vec(), -7.0);
        let largest = u64::MAX.to_le_bytes();
        assert_eq!(Scalar::U64.whole(&largest, ByteOrder::Little), Some(None));
        let rounded = Scalar::U64.coordinate(&largest, ByteOrder::Little);
        assert_eq!(rounded.expect("enough bytes").wide, 2_f64.powi(64));
        assert_eq!(
            Scalar::F64.whole(&f64::NAN.to_le_bytes(), ByteOrder::Little),
            Some(None)
        );
        assert_eq!(
            Scalar::F64.whole(&1e300_f64.to_le_bytes(), ByteOrder::Little),
            Some(None)
        );
    }
}
