//! The axis of ratios of two times: logarithmic, with 1 in the middle, faster on the left.

use crate::axes::LogScale;
use crate::canvas::{Canvas, Style, text_width};
use crate::colours::{FAINT_COLOUR, GRID_COLOUR, TEXT_COLOUR};

/// Ratios beyond this one are drawn at the end of the axis.
pub(super) const FARTHEST: f64 = 1000.0;

/// Labels of an axis. Their inverses are also short.
const TICKS: [f64; 6] = [1.25, 2.0, 4.0, 10.0, 100.0, 1000.0];

/// Returns a scale of which 1 is the middle, and which has all `ratios`. It reaches at least from 2/3 to
/// 1.5, so that noise does not fill a figure.
pub(super) fn scale(ratios: impl Iterator<Item = f64>, pixels: [f64; 2]) -> LogScale {
    let distances = ratios.map(|ratio| ratio.max(ratio.recip()));
    let most = distances.fold(1.5, f64::max).min(FARTHEST) * 1.04;
    LogScale {
        values: [most.recip(), most],
        pixels,
    }
}

/// Draws the words of both directions above `top`, and the lines and labels from `top` to `bottom`.
pub(super) fn draw(canvas: &mut Canvas, scale: LogScale, [top, bottom]: [f64; 2]) {
    let one = scale.place(1.0);
    let words = Style::new(12).bold(true);
    canvas.text([one - 12.0, top - 22.0], "← faster", words.end());
    canvas.text([one + 12.0, top - 22.0], "slower →", words);
    let faint = Style::new(12).colour(FAINT_COLOUR).middle();
    let mut taken: Vec<[f64; 2]> = Vec::new();
    for tick in [1.0].into_iter().chain(TICKS) {
        if tick > scale.values[1] {
            break;
        }
        let mut ratios = vec![tick.recip(), tick];
        ratios.dedup();
        let sides = ratios.into_iter().map(|ratio| {
            let (x, label) = (scale.place(ratio), ratio.to_string());
            let half = text_width(&label, 12) / 2.0 + 4.0;
            (x, label, [x - half, x + half])
        });
        let sides: Vec<_> = sides.collect();
        let is_free =
            |[from, to]: [f64; 2]| taken.iter().all(|other| to <= other[0] || from >= other[1]);
        // Both sides have labels, or none.
        let are_free = sides.iter().all(|(.., place)| is_free(*place));
        for (x, label, place) in sides {
            let colour = if tick == 1.0 {
                TEXT_COLOUR
            } else {
                GRID_COLOUR
            };
            canvas.line([x, top], [x, bottom], colour, 1.0);
            if are_free {
                taken.push(place);
                for y in [top - 6.0, bottom + 14.0] {
                    canvas.text([x, y], &label, faint);
                }
            }
        }
    }
}
