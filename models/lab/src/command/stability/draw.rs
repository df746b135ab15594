//! A chart per difficulty: success, the adjusted Rand index and the error over the levels, side by side under one legend.

use anyhow::Result;
use plotters::coord::Shift;
use plotters::coord::ranged1d::ValueFormatter;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use dvp_cli::chart::{self, FONT};

use super::summary::{LevelSummary, SweepSummary, label};

/// Width and height of the chart, width of its legend, heights of its title and of the levels' names, px.
const SIZE: (u32, u32) = (1500, 380);
const LEGEND: u32 = 150;
const TITLE: u32 = 32;
const NAMES: i32 = 44;
/// Height of text, px.
const TEXT: i32 = 13;
/// Marks of one level stand so far apart, in levels: what has the same value is seen.
const APART: f64 = 0.06;
/// Colors of the methods: those that are told apart also without colors of red and green. Methods that come late are told by
/// their rings.
const COLORS: &[RGBColor] = chart::COLORS.split_at(6).0;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// One quantity over the levels.
struct Panel {
    y: &'static str,
    of: fn(&LevelSummary) -> f64,
}

/// The chart of a sweep, as SVG.
///
/// # Errors
/// If plotters refuses.
pub(super) fn svg(sweep: &SweepSummary) -> Result<String> {
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        area.fill(&WHITE)?;
        let (plots, legend) = area.split_horizontally(SIZE.0 - LEGEND);
        let (title, below) = plots.split_vertically(TITLE);
        text(&title, sweep.title, (16, 18), 18, HPos::Left)?;
        let parts = below.split_evenly((1, 3));
        let right = f64::from(u32::try_from(sweep.levels().len()).unwrap_or(u32::MAX)) - 0.5;
        if let [left_part, middle_part, right_part] = &parts[..] {
            let success = Panel { y: "success", of: |level| level.success };
            let mut plot = builder(left_part).build_cartesian_2d(-0.5..right, -0.04..1.04)?;
            mesh(&mut plot, &success, |y| format!("{y:.1}"))?;
            lines(left_part, &plot, &success, sweep, |_| true)?;
            let ari = Panel { y: "adjusted Rand index", of: |level| level.ari };
            // Masks by chance have an index about 0, which may be below it.
            let mut plot = builder(middle_part).build_cartesian_2d(-0.5..right, -0.04..1.04)?;
            mesh(&mut plot, &ari, |y| format!("{y:.1}"))?;
            lines(middle_part, &plot, &ari, sweep, |_| true)?;
            let error = Panel { y: "mean absolute error of the picture", of: |level| level.mae };
            let (low, high) = ends(sweep, error.of);
            let mut plot = builder(right_part).build_cartesian_2d(-0.5..right, (low / 1.6..high * 1.6).log_scale())?;
            mesh(&mut plot, &error, |y| format!("{y:.0e}"))?;
            lines(right_part, &plot, &error, sweep, |value| value > 0.0)?;
        }
        for ((k, method), y) in sweep.methods.iter().enumerate().zip((48..).step_by(20)) {
            mark(&legend, k, (10, y))?;
            text(&legend, &method.method, (22, y), TEXT, HPos::Left)?;
        }
        area.present()?;
    }
    Ok(svg)
}

fn builder<'a, 'b>(area: &'a Area<'b>) -> ChartBuilder<'a, 'b, SVGBackend<'b>> {
    let mut builder = ChartBuilder::on(area);
    builder.margin(8).x_label_area_size(NAMES).y_label_area_size(64);
    builder
}

/// Frame, grid and the vertical axis.
fn mesh<Y>(
    plot: &mut ChartContext<'_, SVGBackend<'_>, Cartesian2d<RangedCoordf64, Y>>,
    panel: &Panel,
    format: fn(&f64) -> String,
) -> Result<()>
where
    Y: Ranged<ValueType = f64> + ValueFormatter<f64>,
{
    plot.configure_mesh()
        .disable_x_mesh()
        .x_labels(0)
        .y_desc(panel.y)
        .y_label_formatter(&format)
        .label_style((FONT, TEXT - 1))
        .axis_desc_style((FONT, TEXT))
        .light_line_style(TRANSPARENT)
        .bold_line_style(BLACK.mix(0.12))
        .draw()?;
    Ok(())
}

/// Lines and marks of a panel, and the names of the levels under it.
fn lines<'a, Y: Ranged<ValueType = f64>>(
    area: &Area<'a>,
    plot: &ChartContext<'_, SVGBackend<'a>, Cartesian2d<RangedCoordf64, Y>>,
    panel: &Panel,
    sweep: &SweepSummary,
    is_shown: fn(f64) -> bool,
) -> Result<()> {
    // Plots have pixels of the whole chart, parts their own.
    let (across, down) = area.get_pixel_range();
    let own = |(x, y): (i32, i32)| (x - across.start, y - down.start);
    let middle = 0.5 * (f64::from(u32::try_from(sweep.methods.len()).unwrap_or(0)) - 1.0);
    for (k, method) in (0_u32..).zip(&sweep.methods) {
        let aside = APART * (f64::from(k) - middle);
        let values = (0_u32..).zip(&method.levels).map(|(at, level)| (f64::from(at) + aside, (panel.of)(level)));
        let shown = values.filter(|(_, value)| value.is_finite() && is_shown(*value));
        let points: Vec<_> = shown.map(|point| own(plot.backend_coord(&point))).collect();
        let color = COLORS[k as usize % COLORS.len()];
        area.draw(&PathElement::new(points.clone(), color.mix(0.6)))?;
        for point in points {
            mark(area, k as usize, point)?;
        }
    }
    let (_, floor) = plot.plotting_area().get_pixel_range();
    let row = floor.end - down.start + 10;
    let levels = sweep.levels();
    let column = |at: f64| own(plot.backend_coord(&(at, plot.y_range().start))).0;
    for (at, level) in (0_u32..).zip(&levels) {
        text(area, &label(*level), (column(f64::from(at)), row), TEXT - 1, HPos::Center)?;
    }
    let last = f64::from(u32::try_from(levels.len()).unwrap_or(0)) - 1.0;
    text(area, sweep.axis, (column(0.5 * last), row + 18), TEXT, HPos::Center)
}

/// The mark of a method: a disk, or a ring where colors come round.
fn mark(area: &Area<'_>, method: usize, at: (i32, i32)) -> Result<()> {
    let color = COLORS[method % COLORS.len()];
    let style = if method < COLORS.len() { color.filled() } else { color.stroke_width(2) };
    Ok(area.draw(&Circle::new(at, 4, style))?)
}

fn text(area: &Area<'_>, text: &str, at: (i32, i32), height: i32, side: HPos) -> Result<()> {
    let style = (FONT, height).into_text_style(area).pos(Pos::new(side, VPos::Center));
    Ok(area.draw_text(text, &style, at)?)
}

/// The least and the greatest value above 0.
fn ends(sweep: &SweepSummary, of: fn(&LevelSummary) -> f64) -> (f64, f64) {
    let values = sweep.methods.iter().flat_map(|method| &method.levels).map(of);
    let above = values.filter(|value| *value > 0.0 && value.is_finite());
    let (low, high) = above.fold((f64::INFINITY, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)));
    if low <= high { (low, high) } else { (0.1, 1.0) }
}
