//! What a change of the drawing does to the picture, from the pixels around the change alone.
//!
//! A fit compares hundreds of drawings with its image, each like the one before but for an object. The last rendering is
//! kept; where two drawings differ in few objects, only the window that those reach is rendered and compared again. So the
//! time of a comparison follows the size of the object and not that of the picture.

use alloc::vec::Vec;

use dvp_core::geometry::Bounds;
use dvp_core::render::contour::ContourRenderer;
use dvp_core::render::{Compositing, EdgeProfile, Renderer};
use dvp_core::{Drawing, ImageSize, ImageView, Real, Vec2};

use crate::FitError;
use crate::residual::{PixelBox, Residual};

/// Images of at most this many pixels are rendered as a whole: as fast, and one window less to think of.
const SMALL_PIXELS: usize = 1 << 16;
/// A window of more than this share of the pixels, in parts per 4, is not worth its bookkeeping.
const LARGE_WINDOW: usize = 2;
/// Pixels around the reach of an edge, for rounding.
const SLACK_PX: f64 = 2.0;

/// The drawing last rendered, the rendering, and how far it is from the image.
#[derive(Debug, Default)]
pub(super) struct Shown<T: Real> {
    drawing: Drawing<T>,
    setting: Option<(EdgeProfile<T>, Compositing)>,
    pixels: Vec<T>,
    /// Sum of absolute errors of `pixels`.
    error: f64,
    render: <ContourRenderer<T> as Renderer<T>>::Scratch,
    window: Drawing<T>,
    window_pixels: Vec<T>,
    outline: Vec<[T; 2]>,
}

impl<T: Real> Shown<T> {
    /// Forgets the last rendering: the image is another one.
    pub(super) fn forget(&mut self) {
        self.setting = None;
    }

    /// The last rendering, planar.
    pub(super) fn pixels(&self) -> &[T] {
        &self.pixels
    }

    /// Memory for renderings of other kinds.
    pub(super) fn render_scratch(&mut self) -> &mut <ContourRenderer<T> as Renderer<T>>::Scratch {
        &mut self.render
    }

    /// Renders `drawing` where it differs from the last one, brings `residual` up to date, and returns the mean absolute
    /// error.
    pub(super) fn compare(
        &mut self,
        drawing: &Drawing<T>,
        image: &ImageView<'_, T>,
        (edge, compositing): (EdgeProfile<T>, Compositing),
        residual: &mut Residual<T>,
    ) -> Result<T, FitError> {
        let size = image.size();
        let values = T::of_usize(image.data().len());
        if size.pixels() <= SMALL_PIXELS {
            self.pixels.resize(image.data().len(), T::zero());
            ContourRenderer::new(edge, compositing).render(drawing, size, &mut self.render, &mut self.pixels)?;
            return Ok(residual.measure(image, &self.pixels));
        }
        let known = self.setting == Some((edge, compositing)) && self.drawing.background == drawing.background;
        let change = if known { self.change(drawing, edge, size) } else { Change::Everything };
        match change {
            Change::Nothing => {}
            Change::Window(window) => {
                let before = window_error(&self.pixels, image, window);
                self.render_window(drawing, image, window, (edge, compositing))?;
                residual.measure_window(image, &self.pixels, window);
                self.error += window_error(&self.pixels, image, window) - before;
                self.drawing.clone_from(drawing);
            }
            Change::Everything => {
                self.setting = None;
                self.pixels.resize(image.data().len(), T::zero());
                ContourRenderer::new(edge, compositing).render(drawing, size, &mut self.render, &mut self.pixels)?;
                self.error = (residual.measure(image, &self.pixels) * values).as_f64();
                self.drawing.clone_from(drawing);
                self.setting = Some((edge, compositing));
            }
        }
        Ok(T::of(self.error) / values)
    }

    /// Where the drawing differs from the last one: all but the first and the last objects that are the same.
    fn change(&self, drawing: &Drawing<T>, edge: EdgeProfile<T>, size: ImageSize) -> Change {
        let (old, new) = (&self.drawing, drawing);
        let (m, n) = (old.object_count(), new.object_count());
        let least = m.min(n);
        let same = |i: usize, j: usize| {
            old.colors[i] == new.colors[j]
                && old.confidences[i] == new.confidences[j]
                && old.outline(i) == new.outline(j)
        };
        let first = (0..least).take_while(|&i| same(i, i)).count();
        let last = (0..least - first).take_while(|&i| same(m - 1 - i, n - 1 - i)).count();
        if first == m && m == n {
            return Change::Nothing;
        }
        let unit = T::of_usize(size.unit_px());
        let changed = (first..m - last).map(|i| old.outline(i)).chain((first..n - last).map(|j| new.outline(j)));
        match pixels_around(changed.flatten(), unit, reach_px(edge, unit), size) {
            None => Change::Nothing,
            Some(window) if 4 * window.pixels() <= LARGE_WINDOW * size.pixels() => Change::Window(window),
            Some(_) => Change::Everything,
        }
    }

    /// Renders the objects that reach the window, in a frame of its own, and copies it to its place.
    fn render_window(
        &mut self,
        drawing: &Drawing<T>,
        image: &ImageView<'_, T>,
        window: PixelBox,
        (edge, compositing): (EdgeProfile<T>, Compositing),
    ) -> Result<(), FitError> {
        let Ok(here) = ImageSize::new(window.width(), window.height()) else { return Ok(()) };
        let size = image.size();
        let (unit, unit_here) = (T::of_usize(size.unit_px()), T::of_usize(here.unit_px()));
        let reach = reach_px(edge, unit);
        let origin = window.low.map(T::of_usize);
        self.window.clear();
        self.window.background = drawing.background;
        for k in 0..drawing.object_count() {
            let own = pixels_around(drawing.outline(k), unit, reach, size);
            if own.is_some_and(|pixels| pixels.meets(&window)) {
                self.outline.clear();
                let to_here = |v: &[T; 2]| core::array::from_fn(|c| (v[c] * unit - origin[c]) / unit_here);
                self.outline.extend(drawing.outline(k).iter().map(to_here));
                self.window.push(&self.outline, drawing.colors[k], drawing.confidences[k]);
            }
        }
        self.window_pixels.resize(3 * here.pixels(), T::zero());
        let renderer = ContourRenderer::new(edge.magnified(unit / unit_here), compositing);
        renderer.render(&self.window, here, &mut self.render, &mut self.window_pixels)?;
        for (c, plane) in self.window_pixels.chunks_exact(here.pixels()).enumerate() {
            for (row, line) in (window.low[1]..).zip(plane.chunks_exact(here.width())) {
                let at = c * size.pixels() + row * size.width() + window.low[0];
                self.pixels[at..at + here.width()].copy_from_slice(line);
            }
        }
        Ok(())
    }
}

/// How far a drawing is from the last one.
enum Change {
    /// The picture is the same.
    Nothing,
    /// Pixels outside of the window are the same.
    Window(PixelBox),
    /// Too much to be worth a window.
    Everything,
}

/// Pixels that an edge reaches beyond its outline.
fn reach_px<T: Real>(edge: EdgeProfile<T>, unit: T) -> T {
    let profile = edge.in_pixels(unit);
    profile.px(profile.cut) + T::of(SLACK_PX)
}

/// Sum of absolute errors in a window.
fn window_error<T: Real>(pixels: &[T], image: &ImageView<'_, T>, window: PixelBox) -> f64 {
    let plane = image.size().pixels();
    let lines = (0..3).flat_map(|c| window.rows(image.size().width()).map(move |line| (c, line)));
    let sum = |(c, line): (usize, core::ops::Range<usize>)| -> T {
        let rendered = &pixels[c * plane + line.start..c * plane + line.end];
        image.channel(c)[line].iter().zip(rendered).map(|(&a, &b)| (a - b).abs()).sum()
    };
    lines.map(|line| sum(line).as_f64()).sum()
}

/// The pixels of the image within `reach` (px) of the box around vertices; none if there is none.
fn pixels_around<'a, T: Real>(
    vertices: impl IntoIterator<Item = &'a [T; 2]>,
    unit: T,
    reach: T,
    size: ImageSize,
) -> Option<PixelBox> {
    let bounds = Bounds::of(vertices.into_iter().map(|&vertex| Vec2::from(vertex) * unit))?;
    let (min, max) = (bounds.min.to_array(), bounds.max.to_array());
    let extent = [size.width(), size.height()];
    let bound = |v: T, c: usize| v.max(T::zero()).min(T::of_usize(extent[c])).to_count();
    let low: [usize; 2] = core::array::from_fn(|c| bound((min[c] - reach).floor(), c));
    let high: [usize; 2] = core::array::from_fn(|c| bound((max[c] + reach).ceil(), c));
    (low[0] < high[0] && low[1] < high[1]).then_some(PixelBox { low, high })
}
