//! What reports share: tables as CSV, as HTML and as text, and the frame of their pages.
//!
//! A table is its rows of cells, the header first.

use anyhow::{Result, anyhow};
use comfy_table::{Table, presets};
use maud::{DOCTYPE, Markup, PreEscaped, html};

const STYLE: &str = "body{font:15px/1.45 sans-serif;max-width:72em;margin:2em auto;padding:0 1em;color:#222}\
                     table{border-collapse:collapse;margin:1em 0;font-size:13px}\
                     th,td{padding:.25em .6em;border-bottom:1px solid #ddd;text-align:left;white-space:nowrap}\
                     td.n{text-align:right}svg{max-width:100%;height:auto}.bug{color:#b00;font-weight:bold}\
                     .wide{overflow-x:auto}";

/// The rows of a table, the header first.
pub(super) type Cells = Vec<Vec<String>>;

/// A header of these names, to put rows under.
pub(super) fn header<'a>(names: impl IntoIterator<Item = &'a str>) -> Cells {
    vec![names.into_iter().map(str::to_owned).collect()]
}

/// A table as CSV.
///
/// # Errors
/// If a row has more or fewer cells than the header.
pub(super) fn csv(cells: &[Vec<String>]) -> Result<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    cells.iter().try_for_each(|row| writer.write_record(row))?;
    writer.into_inner().map_err(|error| anyhow!("a table: {error}"))
}

/// A page that needs no other file.
pub(super) fn page(title: &str, heading: &str, body: &Markup) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head { meta charset="utf-8"; title { (title) } style { (PreEscaped(STYLE)) } }
            body { h1 { (heading) } (body) }
        }
    };
    page.into_string() + "\n"
}

/// What a page says of the run that it is of.
pub(super) struct Run {
    /// The command that makes the same report, but for the folder.
    pub(super) command: String,
    pub(super) machine: String,
    pub(super) images: usize,
    pub(super) seconds: f64,
}

impl Run {
    /// A paragraph; `threads` says how many there were, if that matters.
    pub(super) fn paragraph(&self, threads: &str) -> Markup {
        let Self { command, machine, images, seconds } = self;
        let seconds = format!("{seconds:.0}");
        html! { p { code { (command) } br; (machine) "; " (threads) (images) " images; " (seconds) " s in all." } }
    }
}

/// The machine, as far as the program knows it.
pub(super) fn machine() -> String {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    format!("{} on {}, {cores} cores", std::env::consts::ARCH, std::env::consts::OS)
}

/// An SVG within a page: without what only a file of its own needs.
pub(super) fn drawing(svg: &str) -> PreEscaped<&str> {
    PreEscaped(svg.find("<svg").map_or(svg, |at| &svg[at..]))
}

/// A table that is scrolled if it is wider than the page.
pub(super) fn wide(rows: &Markup) -> Markup {
    html! { div.wide { table { (rows) } } }
}

/// A table of text.
pub(super) fn table(cells: &[Vec<String>]) -> Markup {
    let (header, rows) = cells.split_at(cells.len().min(1));
    wide(&html! {
        @for row in header { tr { @for cell in row { th { (cell) } } } }
        @for row in rows { tr { @for cell in row { td { (cell) } } } }
    })
}

/// A table for a terminal.
pub(super) fn text_table(cells: Cells) -> String {
    let mut table = Table::new();
    table.load_style(presets::UTF8_HORIZONTAL_ONLY);
    let mut cells = cells.into_iter();
    if let Some(header) = cells.next() {
        table.set_header(header);
    }
    table.add_rows(cells);
    table.trim_fmt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_escaped_as_each_format_wants_it() {
        let mut cells = header(["a", "b"]);
        cells.push(vec!["1 < 2".into(), "x, \"y\"".into()]);
        assert_eq!(String::from_utf8(csv(&cells).unwrap()).unwrap(), "a,b\n1 < 2,\"x, \"\"y\"\"\"\n");
        assert!(table(&cells).into_string().contains("<td>1 &lt; 2</td><td>x, &quot;y&quot;</td>"));
        cells.push(vec!["alone".into()]);
        assert!(csv(&cells).is_err(), "a row that is too short");
    }

    #[test]
    fn drawings_lose_the_head_of_their_file() {
        assert_eq!(drawing("<?xml version=\"1.0\"?>\n<svg></svg>").into_string(), "<svg></svg>");
    }
}
