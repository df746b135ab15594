//! Scratch.
use dvp_core::shape::{Flattening, Outline, OutlineBasis, REFERENCE_VERTICES, Shape as _};
use dvp_core::{ImageSize, ImageView};
use std::io::Read;
fn main() {
    let mut bytes = Vec::new();
    std::io::stdin().read_to_end(&mut bytes).unwrap();
    let word = |k: usize| u32::from_le_bytes(bytes[k..k + 4].try_into().unwrap()) as usize;
    let count = word(0);
    let mut at = 4;
    let basis = OutlineBasis::new(REFERENCE_VERTICES, 1).unwrap();
    for _ in 0..count {
        let [w, h] = [word(at), word(at + 4)];
        at += 8;
        let data: Vec<f32> = bytes[at..at + 3 * w * h].iter().map(|&b| f32::from(b) / 255.0).collect();
        at += 3 * w * h;
        let size = ImageSize::new(w, h).unwrap();
        let image = ImageView::new(size, &data).unwrap();
        let start = std::time::Instant::now();
        let traced = dvp_trace::trace(&image, &dvp_trace::Known::default());
        let ms = start.elapsed().as_secs_f64() * 1e3;
        let Ok(traced) = traced else {
            println!("{{\"ms\":{ms},\"objects\":null}}");
            continue;
        };
        let unit = size.unit_px() as f64;
        let mut out = String::new();
        let scene = traced.scene.cast::<f64>();
        for (k, object) in scene.objects.iter().enumerate() {
            let mut outline = Outline::default();
            object.shape.flatten(&Flattening::new(&basis, 1e-3 / unit), &mut outline).unwrap();
            object.pose.transform(&mut outline.vertices);
            let rings: Vec<String> = outline
                .rings()
                .iter()
                .map(|ring| format!("{:?}", ring.iter().map(|v| v.map(|x| x * unit)).collect::<Vec<_>>()))
                .collect();
            let cov = traced.covariances[k].as_ref().map_or("null".to_string(), |c| format!("{:?}", c.numbers));
            let shape = match &object.shape {
                dvp_core::shape::AnyShape::Circle(c) => format!("[{:?},{:?}]", c.radius * unit, c.radius * unit),
                dvp_core::shape::AnyShape::Ellipse(e) => format!("{:?}", e.radii.map(|r| r * unit)),
                dvp_core::shape::AnyShape::Rectangle(e) => format!("{:?}", e.size.map(|r| r * unit)),
                _ => "null".to_string(),
            };
            out += &format!(
                "{}{{\"kind\":\"{}\",\"x\":{:?},\"rot\":{},\"shape\":{},\"cov\":{},\"color\":{:?},\"rings\":[{}]}}",
                if k > 0 { "," } else { "" },
                object.shape.kind(),
                object.pose.translation.map(|x| x * unit),
                object.pose.rotation,
                shape,
                cov,
                object.color(),
                rings.join(",")
            );
        }
        println!("{{\"ms\":{ms},\"bits\":{},\"background\":{:?},\"objects\":[{out}]}}", traced.bits, scene.background);
    }
}
