//! What the pages of reports share.

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
