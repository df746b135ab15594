//! What reports share: the frame of their pages, and tables as HTML and as text.

use comfy_table::{Table, presets};

const STYLE: &str = "body{font:15px/1.45 sans-serif;max-width:72em;margin:2em auto;padding:0 1em;color:#222}\
                     table{border-collapse:collapse;margin:1em 0;font-size:13px}\
                     th,td{padding:.25em .6em;border-bottom:1px solid #ddd;text-align:left;white-space:nowrap}\
                     td.n{text-align:right}svg{max-width:100%;height:auto}.bug{color:#b00;font-weight:bold}\
                     .wide{overflow-x:auto}";

/// A page up to its heading; it ends with [`END`].
pub(super) fn begin(title: &str, heading: &str) -> String {
    format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{title}</title>\n\
         <style>{STYLE}</style></head><body>\n<h1>{heading}</h1>\n"
    )
}

/// The end of a page.
pub(super) const END: &str = "</body></html>\n";

/// Text as HTML has it.
pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// The machine, as far as the program knows it.
pub(super) fn machine() -> String {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    format!("{} on {}, {cores} cores", std::env::consts::ARCH, std::env::consts::OS)
}

/// A drawing without what only a file of its own needs.
pub(super) fn inline(svg: &str) -> &str {
    svg.find("<svg").map_or(svg, |at| &svg[at..])
}

/// Cells, the header first, as a table.
pub(super) fn table(cells: &[Vec<String>]) -> String {
    let mut html = "<div class=\"wide\"><table>\n".to_owned();
    for (k, row) in cells.iter().enumerate() {
        let tag = if k == 0 { "th" } else { "td" };
        let row: String = row.iter().map(|cell| format!("<{tag}>{}</{tag}>", escaped(cell))).collect();
        html += &format!("<tr>{row}</tr>\n");
    }
    html + "</table></div>\n"
}

/// The same cells for a terminal.
pub(super) fn text_table(cells: Vec<Vec<String>>) -> String {
    let mut table = Table::new();
    table.load_style(presets::UTF8_HORIZONTAL_ONLY);
    let mut cells = cells.into_iter();
    if let Some(header) = cells.next() {
        table.set_header(header);
    }
    table.add_rows(cells);
    table.trim_fmt()
}
