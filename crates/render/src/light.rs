//! Colours and lighting.

use glam::DVec3;

/// A colour in linear amounts of red, green and blue. Linear amounts can be added and averaged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Colour(pub(crate) DVec3);

/// The background.
pub(crate) const BACKGROUND: Colour = Colour(DVec3::new(0.965, 0.965, 0.958));
/// The outer side of a surface.
const OUTSIDE: Colour = Colour(DVec3::new(0.30, 0.42, 0.60));
/// The inner side of a surface.
const INSIDE: Colour = Colour(DVec3::new(0.66, 0.47, 0.26));
/// Edges.
pub(crate) const EDGE: Colour = Colour(DVec3::new(0.018, 0.030, 0.055));
/// Faces that are turned against their neighbours.
const TURNED: Colour = Colour(DVec3::new(0.80, 0.62, 0.03));
/// Boundary edges that are painted as faults.
pub(crate) const BOUNDARY: Colour = Colour(DVec3::new(0.95, 0.32, 0.0));
/// Non-manifold edges and vertices that are painted as faults.
pub(crate) const NON_MANIFOLD: Colour = Colour(DVec3::new(0.70, 0.0, 0.62));
/// Sharp edges and corners.
pub(crate) const CREASE: Colour = Colour(DVec3::new(0.86, 0.075, 0.020));

impl Colour {
    /// Returns the mixture of `share` of `other` and `1 - share` of this colour.
    pub(crate) fn mix(self, other: Self, share: f64) -> Self {
        Self(self.0.lerp(other.0, share))
    }

    /// Returns the sRGB codes (IEC 61966-2-1).
    pub(crate) fn srgb_codes(self) -> [u8; 3] {
        self.0.to_array().map(|light| {
            let light = light.clamp(0.0, 1.0);
            let code = if light <= 0.003_130_8 {
                12.92 * light
            } else {
                1.055 * light.powf(1.0 / 2.4) - 0.055
            };
            (code * 255.0).round() as u8
        })
    }

    /// Returns the colour in the form `#rrggbb`.
    pub(crate) fn to_hex(self) -> String {
        let [r, g, b] = self.srgb_codes();
        format!("#{r:02x}{g:02x}{b:02x}")
    }
}

/// The side of a surface that is seen.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Seen {
    Outside,
    Inside,
    /// A side of a face that is painted as turned; `true` for the inner side.
    Turned(bool),
}

/// Returns the colour of a surface with this normal, in the axes of the picture. `seen` selects the
/// colour.
///
/// The light is the sum of five parts: a key light from the upper left and a weak light from the
/// right (Lambert 1760), light from the sky, a soft highlight (Blinn 1977), and light along the
/// rim.
pub(crate) fn shade(normal: DVec3, seen: Seen) -> Colour {
    let normal = normal.normalize_or(DVec3::Z);
    let (normal, base) = match seen {
        Seen::Outside => (normal, OUTSIDE),
        Seen::Inside => (-normal, INSIDE),
        Seen::Turned(false) => (normal, TURNED),
        Seen::Turned(true) => (-normal, TURNED),
    };
    let key = DVec3::new(-0.46, 0.62, 0.64).normalize();
    let fill = DVec3::new(0.84, 0.05, 0.54).normalize();
    let sky = 0.5 + 0.5 * normal.y;
    let light =
        0.16 + 0.20 * sky + 0.92 * normal.dot(key).max(0.0) + 0.20 * normal.dot(fill).max(0.0);
    let half = (key + DVec3::Z).normalize();
    let highlight = 0.10 * normal.dot(half).max(0.0).powi(24);
    let rim = 0.16 * (1.0 - normal.z.clamp(0.0, 1.0)).powi(3) * sky;
    Colour(base.0 * light + DVec3::splat(highlight + rim))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn linear_light_is_converted_to_srgb() {
        let grey = |light| Colour(DVec3::splat(light)).srgb_codes()[0];
        // In sRGB, half of the full light has code 188. Values out of range are clamped.
        let codes = [-1.0, 0.0, 0.002, 0.215_861, 0.5, 1.0, 7.0].map(grey);
        assert_eq!(codes, [0, 0, 7, 128, 188, 255, 255]);
        assert_eq!(Colour(DVec3::X).to_hex(), "#ff0000");
    }

    #[test]
    fn light_comes_from_the_upper_left_and_a_surface_has_two_sides() {
        let bright = |x, y, z| shade(DVec3::new(x, y, z), Seen::Outside).0.element_sum();
        assert!(bright(-1.0, 1.0, 1.0) > bright(1.0, 1.0, 1.0));
        assert!(bright(0.0, 1.0, 1.0) > bright(0.0, -1.0, 1.0));
        let inside = shade(DVec3::NEG_Z, Seen::Inside);
        assert!(inside.0.x > inside.0.z);
        let outside = shade(DVec3::Z, Seen::Outside);
        assert!(outside.0.z > outside.0.x);
        let turned = [true, false].map(|inside| shade(DVec3::Z, Seen::Turned(inside)));
        assert!(turned.iter().all(|colour| colour.0.x > 2.0 * colour.0.z));
        assert!(shade(DVec3::ZERO, Seen::Outside).0.is_finite());
    }
}
