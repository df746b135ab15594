use dvp_core::shape::{AnyShape, FillRule, PathRing, Shape as _};
use kurbo::Affine;

use super::super::figure::Figure;
use super::super::place::Frame;
use super::super::{SvgDrawing, from_svg};
use super::{objects, one, read};
use crate::svg::to_svg;

#[test]
fn hostile_texts_are_refused_with_a_reason() {
    let deep = |depth: usize| format!("{}<circle r='1'/>{}", "<g>".repeat(depth), "</g>".repeat(depth));
    assert!(read(&deep(100)).is_ok());
    let doubling = |levels: usize| {
        let level = |k: usize| format!("<g id='g{}'><use href='#g{k}'/><use href='#g{k}'/></g>", k + 1);
        let groups: String = (0..levels).map(level).collect();
        format!("<defs><g id='g0'><circle r='1'/></g>{groups}</defs><use href='#g{levels}'/>")
    };
    assert_eq!(objects(&doubling(3)).len(), 8);
    let chain = |count: usize| {
        let links: String = (0..count).map(|k| format!("<g id='g{}'><use href='#g{k}'/></g>", k + 1)).collect();
        format!("<g id='g0'/>{links}")
    };
    let clips = "<clipPath id='a' clip-path='url(#b)'><circle r='1'/></clipPath><clipPath id='b' clip-path='url(#c)'>
        <circle r='1'/></clipPath><clipPath id='c' clip-path='url(#a)'><circle r='1'/></clipPath>";
    let styled = "<style>#a{mask:url(#b)}</style><mask id='b'><g id='a'/></mask><rect width='5' height='5'/>";
    let markers = format!(
        "<marker id='m'><g>{}</g></marker><path marker-mid='url(#m)' d='M0 0{}'/>",
        "<circle r='1'/>".repeat(1000),
        "h1".repeat(1000)
    );
    let laughs = "<!DOCTYPE svg [<!ENTITY a 'ha'><!ENTITY b '&a;&a;&a;&a;&a;&a;'>]>".to_owned();
    let laughs =
        laughs + &format!("<svg xmlns='http://www.w3.org/2000/svg'><text>{}</text></svg>", "&b;".repeat(1 << 18));
    for (text, reason) in [
        ("<svg".to_owned(), "not XML"),
        ("<html/>".to_owned(), "not a readable SVG"),
        ("<svg xmlns='http://www.w3.org/2000/svg' width='0' height='5'/>".to_owned(), "not a readable SVG"),
        ("<svg xmlns='http://www.w3.org/2000/svg' width='1e6' height='5'/>".to_owned(), "each side must be"),
        (laughs, "entities"),
    ] {
        let error = from_svg(&text).unwrap_err().to_string();
        assert!(error.contains(reason), "{reason}: {error}");
    }
    for (body, reason) in [
        (deep(200), "nested"),
        (chain(100), "nested"),
        (doubling(40), "more than 262144 elements"),
        (
            "<g id='a'><use href='#b'/></g><g id='b'><use href='#c'/></g><g id='c'><use href='#a'/></g>".to_owned(),
            "uses itself",
        ),
        (clips.to_owned(), "uses itself"),
        (styled.to_owned(), "uses itself"),
        (markers, "more than 262144 elements"),
        ("<circle r='1e30'/>".to_owned(), "beyond 10000000"),
        ("<circle r='5em'/>".to_owned(), "em or ex"),
        ("<path d='M0 0A1e300 1e300 0 1 1 1 1'/>".to_owned(), "beyond 10000000"),
        ("<circle r='1' transform='scale(1e9)'/>".to_owned(), "px from its upper left corner"),
    ] {
        let error = read(&body).unwrap_err().to_string();
        assert!(error.contains(reason), "{reason}: {error}");
    }
}

#[test]
fn shapes_of_entities_are_read() {
    let text = "<!DOCTYPE svg [<!ENTITY x \"<circle r='5'/>\">]>\
         <svg xmlns='http://www.w3.org/2000/svg' width='100' height='100'>&x;<rect width='5' height='4'/>&x;</svg>";
    let SvgDrawing { scene, losses, .. } = from_svg(text).unwrap();
    let kinds: Vec<_> = scene.objects.iter().map(|object| object.shape.kind()).collect();
    assert_eq!(kinds, ["circle", "rectangle", "circle"]);
    assert!(losses.is_empty(), "{losses}");
}

#[test]
fn units_of_fonts_matter_where_something_is_drawn() {
    let drawing = read("<text x='1em' y='1em'>a</text><circle r='5'/>").unwrap();
    assert_eq!((drawing.scene.objects.len(), drawing.losses.to_string().as_str()), (1, "text: not drawn"));
    for body in ["<circle r='5em'/>", "<rect width='5ex' height='5'/>", "<svg width='5em'><circle r='5'/></svg>"] {
        let error = read(body).unwrap_err().to_string();
        assert!(error.contains("em or ex"), "{body}: {error}");
    }
}

#[test]
fn dashes_count_however_often_they_are_used() {
    let uses = "<use href='#a'/>".repeat(1000);
    // 25,000 dashes each.
    for transform in ["", " transform='scale(1 2)'"] {
        let path = format!("<path id='a' d='M0 0H100' stroke='red' stroke-dasharray='.002'{transform}/>");
        assert!(read(&path).is_ok());
        let error = read(&format!("{path}{uses}")).unwrap_err().to_string();
        assert!(error.contains("more than 262144 lines and curves"), "{error}");
    }
}

#[test]
fn nonsense_numbers_draw_nothing_or_are_said() {
    for (body, count, losses) in [
        ("<circle r='NaN'/>", 0, ""),
        ("<circle r='-5'/>", 0, ""),
        // A missing radius is the other one.
        ("<ellipse rx='5'/>", 1, ""),
        ("<rect width='5'/>", 0, ""),
        ("<polygon points='1 2 3'/>", 0, ""),
        ("<path d='M nan nan L 5 5'/>", 0, ""),
        ("<path d=''/>", 0, ""),
        ("<path d='M1e40 0L1e40 9L0 0'/>", 0, ""),
        ("<g transform='scale(0)'><circle r='5'/></g>", 0, ""),
        ("<g transform='matrix(1 1 1 1 0 0)'><circle r='5' stroke='red'/></g>", 0, ""),
        // A dot.
        ("<path d='M0 0z' stroke='red' stroke-linecap='round'/>", 1, ""),
        ("<path d='M0 0z' stroke='red' transform='scale(1 2)'/>", 0, ""),
        ("<path d='M5 5A5 5 0 0 1 5 5' stroke='red'/>", 0, ""),
        ("<path d='M0 0H50' stroke='red' stroke-dasharray='1e-9'/>", 1, "stroke-dasharray: drawn without gaps"),
    ] {
        let drawing = read(body).unwrap();
        let found = (drawing.scene.objects.len(), drawing.losses.to_string());
        assert_eq!(found, (count, losses.to_owned()), "{body}");
        assert!(to_svg(&drawing.scene, drawing.size, None).is_ok(), "{body}");
    }
}

#[test]
fn what_has_no_boundary_is_an_error_and_not_nothing() {
    let frame = Frame::new(Affine::IDENTITY, 1.0);
    let with =
        |x: f64| Figure::Path { rings: vec![PathRing::polygon(vec![[0.0, 0.0], [x, 0.0], [0.0, 1.0]])], class: None };
    assert!(frame.fill(&with(f64::NAN), FillRule::NonZero, 0.1).is_err());
    assert!(frame.fill(&with(1.0), FillRule::NonZero, 0.1).unwrap().is_some());
    let flat = Figure::Path { rings: vec![PathRing::polyline(vec![[0.0, 0.0], [1.0, 0.0]])], class: None };
    assert!(frame.fill(&flat, FillRule::NonZero, 0.1).unwrap().is_none(), "a line encloses nothing");
    let AnyShape::Path(path) = one("<path d='M0 0H9V9ZM5 5H7'/>").shape else { panic!("no path") };
    assert_eq!(path.rings.len(), 2, "beside others it stays");
}
