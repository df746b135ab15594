//! Line charts as SVG.

use std::path::Path;

use anyhow::{Result, bail};
use plotters::prelude::*;

use crate::format::write_atomic;

/// Width and height, px.
const SIZE: (u32, u32) = (480, 320);

/// One line with a dot at every point.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// Above the plot.
    pub title: &'static str,
    /// Under the horizontal axis.
    pub x: &'static str,
    /// Beside the vertical axis.
    pub y: &'static str,
    /// Points from left to right.
    pub points: Vec<(f64, f64)>,
}

/// Refuses names that charts are not written to, before any work is done.
///
/// # Errors
/// If the name does not end in .svg.
pub fn check_name(file: &Path) -> Result<()> {
    if file.extension().is_none_or(|ending| ending != "svg") {
        bail!("{}: charts are drawn as .svg", file.display());
    }
    Ok(())
}

/// Writes the chart as SVG, whole or not at all.
///
/// # Errors
/// If the name of the file does not end in .svg, or it cannot be written.
pub fn write_chart(chart: &Chart, file: &Path) -> Result<()> {
    check_name(file)?;
    Ok(write_atomic(file, to_svg(chart)?.as_bytes())?)
}

/// The text of the SVG.
///
/// # Errors
/// If a point is not finite.
pub fn to_svg(chart: &Chart) -> Result<String> {
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        area.fill(&WHITE)?;
        let last = chart.points.last().map_or(1.0, |point| point.0);
        let first = chart.points.first().map_or(0.0, |point| point.0);
        let least = chart.points.iter().map(|point| point.1).fold(0.0, f64::min);
        let mut plot = ChartBuilder::on(&area)
            .caption(chart.title, ("sans-serif", 18))
            .margin(12)
            .x_label_area_size(36)
            .y_label_area_size(48)
            .build_cartesian_2d(first - 0.25..last + 0.25, least..1.0)?;
        let steps = chart.points.len().max(2);
        plot.configure_mesh()
            .x_desc(chart.x)
            .y_desc(chart.y)
            .x_labels(steps)
            .x_label_formatter(&|x| format!("{x:.0}"))
            .light_line_style(TRANSPARENT)
            .draw()?;
        plot.draw_series(LineSeries::new(chart.points.iter().copied(), &BLUE))?;
        plot.draw_series(chart.points.iter().map(|&point| Circle::new(point, 3, BLUE.filled())))?;
        area.present()?;
    }
    Ok(svg)
}
