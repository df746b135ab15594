//! Marks on two logarithmic axes, with fronts, labels and a strip for what has no place on the horizontal axis.

use anyhow::Result;
use plotters::coord::Shift;
use plotters::coord::combinators::LogCoord;
use plotters::element::DashedPathElement;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::labels::{Frame, Place, Room};
use super::marks::{Shape, Stamp};
use super::raster;
use dvp_cli::chart::{COLORS, FONT};

/// Width and height, px.
const SIZE: (u32, u32) = (1120, 720);
/// Width of the legend and of the strip, px.
const LEGEND: i32 = 190;
const STRIP: i32 = 150;
/// Radius of marks, px.
const RADIUS: i32 = 5;
/// Heights of text, px.
const TITLE: i32 = 18;
const TEXT: i32 = 13;
/// A PNG has so many pixels per unit of the SVG.
const PNG_ZOOM: u8 = 2;
/// Share of their color that pale marks have.
const PALE: f64 = 0.4;

/// Heights of text in plotters, over what SVG and fonts call its size.
const HEIGHT_PER_EM: f64 = 1.24;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Plot<'a> = ChartContext<'a, SVGBackend<'a>, Cartesian2d<LogCoord<f64>, LogCoord<f64>>>;

/// A point that was measured.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mark {
    /// Where it is; both above 0, or drawn at the edge.
    pub at: (f64, f64),
    /// Quartiles along the horizontal axis.
    pub spread: Option<(f64, f64)>,
    /// What is written beside it.
    pub label: Option<String>,
}

/// Points that belong together.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// In the legend.
    pub name: String,
    /// Which color it has.
    pub color: usize,
    /// Of its marks.
    pub shape: Shape,
    /// Whether only rims are drawn.
    pub hollow: bool,
    /// Whether marks are small and pale.
    pub pale: bool,
    /// Whether a line joins them, in their order.
    pub joined: bool,
    /// The points.
    pub marks: Vec<Mark>,
}

/// Values that have no place on the horizontal axis, in a column of their own.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Strip {
    /// Above it.
    pub title: String,
    /// Names and values.
    pub marks: Vec<(String, f64)>,
}

/// Marks on two logarithmic axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Scatter {
    /// Above the plot.
    pub title: String,
    /// Under the horizontal axis.
    pub x: String,
    /// Beside the vertical axis.
    pub y: String,
    /// Lower end of the vertical axis: what lies below is drawn there.
    pub floor: f64,
    /// What is drawn; the last on top.
    pub series: Vec<Series>,
    /// Steps through these points, from left to right; all but the first dashed, with names for the legend.
    pub fronts: Vec<(String, Vec<(f64, f64)>)>,
    /// What shapes mean, for the legend.
    pub shapes: Vec<(Shape, String)>,
    /// A line across the plot, with its name.
    pub level: Option<(String, f64)>,
    /// Beside the plot.
    pub strip: Option<Strip>,
}

impl Scatter {
    /// The text of the SVG.
    ///
    /// # Errors
    /// If plotters refuses.
    pub fn to_svg(&self) -> Result<String> {
        let mut svg = String::new();
        {
            let area = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
            self.paint(&area)?;
            area.present()?;
        }
        Ok(svg)
    }

    /// The bytes of a PNG, at twice the resolution.
    ///
    /// # Errors
    /// If plotters or resvg refuses.
    pub fn to_png(&self) -> Result<Vec<u8>> {
        raster::png(&self.to_svg()?, PNG_ZOOM)
    }

    fn paint(&self, area: &Area<'_>) -> Result<()> {
        area.fill(&WHITE)?;
        let strip = if self.strip.is_some() { STRIP } else { 0 };
        let [(left, right), (bottom, top)] = self.ranges();
        let mut plot = ChartBuilder::on(area)
            .caption(&self.title, (FONT, TITLE))
            .margin(12)
            .margin_right(LEGEND + strip)
            .x_label_area_size(44)
            .y_label_area_size(72)
            .build_cartesian_2d((left..right).log_scale(), (bottom..top).log_scale())?;
        plot.configure_mesh()
            .x_desc(&self.x)
            .y_desc(&self.y)
            .x_label_formatter(&|x| short(*x))
            .y_label_formatter(&|y| short(*y))
            .label_style((FONT, TEXT))
            .axis_desc_style((FONT, TEXT + 1))
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.12))
            .draw()?;
        Canvas { area, plot: &plot, left, bottom }.paint(self)
    }

    /// Ends of both axes, with some room.
    fn ranges(&self) -> [(f64, f64); 2] {
        let marks = || self.series.iter().flat_map(|series| &series.marks).map(|mark| mark.at);
        let strip = self.strip.iter().flat_map(|strip| &strip.marks).map(|mark| mark.1);
        let strip = strip.chain(self.level.iter().map(|level| level.1));
        let x = ends(marks().map(|at| at.0));
        let y = ends(marks().map(|at| at.1.max(self.floor)).chain(strip));
        [(x.0 / 1.6, x.1 * 1.6), (y.0 / 1.6, y.1 * 1.6)]
    }
}

/// The least and the greatest of the numbers above 0.
fn ends(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let above = values.filter(|value| *value > 0.0 && value.is_finite());
    let (low, high) = above.fold((f64::INFINITY, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)));
    if low <= high { (low, high) } else { (0.1, 1.0) }
}

/// A number without zeros that say nothing: 0.01, 100, 1e-5.
fn short(value: f64) -> String {
    let text = if (1e-3..1e6).contains(&value) { format!("{value:.3}") } else { return format!("{value:.0e}") };
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// What is painted on.
struct Canvas<'a, 'b> {
    area: &'a Area<'b>,
    plot: &'a Plot<'b>,
    left: f64,
    bottom: f64,
}

impl Canvas<'_, '_> {
    fn pixel(&self, (x, y): (f64, f64)) -> (i32, i32) {
        self.plot.backend_coord(&(x.max(self.left), y.max(self.bottom)))
    }

    fn paint(&self, scatter: &Scatter) -> Result<()> {
        let (across, down) = self.plot.plotting_area().get_pixel_range();
        let bounds = [across.start, down.start, across.end, down.end].map(f64::from);
        let mut room = Room::new(bounds);
        for (k, (_, points)) in scatter.fronts.iter().enumerate() {
            self.front(points, (across.end, down.start), k > 0, &mut room)?;
        }
        let level = scatter.level.as_ref().map(|(name, value)| (name, self.pixel((self.left, *value)).1));
        if let Some((_, y)) = level {
            let line = [(across.start, y), (across.end, y)];
            self.area.draw(&PathElement::new(line, BLACK.mix(0.35)))?;
            room.take(around(line[0], line[1]));
        }
        for series in &scatter.series {
            self.series(series, &mut room)?;
        }
        for series in &scatter.series {
            for mark in &series.marks {
                if let Some(label) = &mark.label {
                    self.label(label, self.pixel(mark.at), color(series), &mut room)?;
                }
            }
        }
        if let Some((name, y)) = level {
            self.label(name, ((across.start + 3 * across.end) / 4, y), BLACK.mix(0.35), &mut room)?;
        }
        if let Some(strip) = &scatter.strip {
            self.strip(strip, (across.end, down.start, down.end))?;
        }
        let strip = if scatter.strip.is_some() { STRIP } else { 0 };
        self.legend(scatter, (across.end + (strip + 12), down.start + 8))
    }

    /// Steps from the upper edge through the points to the right one.
    fn front(&self, points: &[(f64, f64)], (right, top): (i32, i32), dashed: bool, room: &mut Room) -> Result<()> {
        let pixels: Vec<_> = points.iter().map(|&point| self.pixel(point)).collect();
        let mut path: Vec<(i32, i32)> = pixels.first().map(|&(x, _)| (x, top)).into_iter().collect();
        for (k, &(x, y)) in pixels.iter().enumerate() {
            path.push((x, y));
            path.push((pixels.get(k + 1).map_or(right, |next| next.0), y));
        }
        for line in path.windows(2) {
            room.take(around(line[0], line[1]));
        }
        self.path(path, dashed)
    }

    /// A line of the front's style.
    fn path(&self, path: Vec<(i32, i32)>, dashed: bool) -> Result<()> {
        let style = BLACK.mix(0.55).stroke_width(2);
        if dashed {
            self.area.draw(&DashedPathElement::new(path, 5, 4, style))?;
        } else {
            self.area.draw(&PathElement::new(path, style))?;
        }
        Ok(())
    }

    fn series(&self, series: &Series, room: &mut Room) -> Result<()> {
        let color = color(series);
        let stamp = self.stamp(series);
        let pixels: Vec<_> = series.marks.iter().map(|mark| self.pixel(mark.at)).collect();
        if series.joined {
            self.area.draw(&PathElement::new(pixels.clone(), color.mix(0.5)))?;
        }
        for (mark, &(x, y)) in series.marks.iter().zip(&pixels) {
            if let Some((low, high)) = mark.spread {
                let [low, high] = [low, high].map(|x| self.pixel((x, mark.at.1)));
                self.area.draw(&PathElement::new([low, high], color.stroke_width(1)))?;
                room.take(around(low, high));
            }
            stamp.paint(self.area, (x, y))?;
            let r = stamp.radius;
            room.take(around((x - r, y - r), (x + r, y + r)));
        }
        Ok(())
    }

    fn stamp(&self, series: &Series) -> Stamp {
        let radius = if series.pale { RADIUS - 2 } else { RADIUS };
        Stamp { shape: series.shape, radius, color: color(series), hollow: series.hollow }
    }

    fn label(&self, label: &str, (x, y): (i32, i32), color: RGBAColor, room: &mut Room) -> Result<()> {
        let width = raster::width(label)? * f64::from(TEXT - 1) / HEIGHT_PER_EM;
        let size = (width + 2.0, f64::from(TEXT));
        let Some(Place { frame, far }) = room.place((f64::from(x), f64::from(y)), size, f64::from(7)) else {
            return Ok(());
        };
        let [left, top, right, bottom] = frame.map(rounded);
        if far {
            let end = (x.clamp(left, right), y.clamp(top, bottom));
            self.area.draw(&PathElement::new([(x, y), end], color.mix(0.6)))?;
        }
        self.text(label, (left, (top + bottom) / 2), TEXT - 1, (HPos::Left, VPos::Center), BLACK.mix(0.85))
    }

    fn text(&self, text: &str, at: (i32, i32), height: i32, (h, v): (HPos, VPos), color: RGBAColor) -> Result<()> {
        let style = (FONT, height).into_text_style(self.area).color(&color).pos(Pos::new(h, v));
        Ok(self.area.draw_text(text, &style, at)?)
    }

    /// The strip from `left` on, between two rows of pixels.
    fn strip(&self, strip: &Strip, (left, top, bottom): (i32, i32, i32)) -> Result<()> {
        let right = left + STRIP;
        let rim = ShapeStyle::from(&BLACK.mix(0.4));
        self.area.draw(&Rectangle::new([(left, top), (right, bottom)], rim))?;
        // What is asked of an error is to be small: there is room below.
        let lines = i32::try_from(strip.title.lines().count()).unwrap_or(0);
        let mut row = bottom - lines * (TEXT + 1);
        for line in strip.title.lines() {
            self.text(line, (left + 6, row), TEXT - 2, (HPos::Left, VPos::Center), BLACK.mix(0.7))?;
            row += TEXT + 1;
        }
        let mut marks: Vec<(&str, i32)> =
            strip.marks.iter().map(|(name, value)| (name.as_str(), self.pixel((self.left, *value)).1)).collect();
        marks.sort_by_key(|mark| mark.1);
        let mut above = top;
        for (name, y) in marks {
            let stamp = Stamp { shape: Shape::Circle, radius: RADIUS, color: BLACK.mix(0.7), hollow: true };
            let x = left + 14;
            stamp.paint(self.area, (x, y))?;
            // Names that would run into each other move down.
            let at = y.max(above + TEXT - 1);
            above = at;
            let start = x + 12;
            if at != y {
                self.area.draw(&PathElement::new([(x + stamp.radius, y), (start - 2, at)], BLACK.mix(0.4)))?;
            }
            self.text(name, (start, at), TEXT - 1, (HPos::Left, VPos::Center), BLACK.mix(0.85))?;
        }
        Ok(())
    }

    fn legend(&self, scatter: &Scatter, (x, mut y): (i32, i32)) -> Result<()> {
        let step = TEXT + 6;
        let name = |text: &str, y: i32| self.text(text, (x + 22, y), TEXT, (HPos::Left, VPos::Center), BLACK.mix(0.9));
        for series in scatter.series.iter().filter(|series| !series.name.is_empty()) {
            self.stamp(series).paint(self.area, (x + 8, y))?;
            name(&series.name, y)?;
            y += step;
        }
        y += step / 2;
        for (shape, text) in &scatter.shapes {
            let stamp = Stamp { shape: *shape, radius: RADIUS, color: BLACK.mix(0.6), hollow: false };
            stamp.paint(self.area, (x + 8, y))?;
            name(text, y)?;
            y += step;
        }
        for (k, (text, _)) in scatter.fronts.iter().enumerate() {
            self.path(vec![(x, y), (x + 17, y)], k > 0)?;
            name(text, y)?;
            y += step;
        }
        Ok(())
    }
}

/// The frame of a line or a square, with a pixel around it.
fn around((x, y): (i32, i32), (right, bottom): (i32, i32)) -> Frame {
    [x.min(right) - 1, y.min(bottom) - 1, x.max(right) + 1, y.max(bottom) + 1].map(f64::from)
}

fn color(series: &Series) -> RGBAColor {
    let color = COLORS[series.color % COLORS.len()];
    color.mix(if series.pale { PALE } else { 1.0 })
}

#[expect(clippy::cast_possible_truncation, reason = "rounding to a pixel")]
fn rounded(value: f64) -> i32 {
    value.round() as i32
}
