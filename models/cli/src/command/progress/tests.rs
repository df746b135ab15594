use alloc::sync::Arc;
use core::time::Duration;
use std::io;
use std::sync::Mutex;
use std::thread;

use indicatif::{ProgressDrawTarget, TermLike};

use super::{hidden, show_after};

/// A terminal that keeps what is written to it.
#[derive(Clone, Debug, Default)]
struct Paper(Arc<Mutex<String>>);

impl Paper {
    fn text(&self) -> String {
        self.0.lock().unwrap().clone()
    }

    fn target(&self) -> impl FnOnce() -> ProgressDrawTarget + Send + 'static {
        let paper = self.clone();
        || ProgressDrawTarget::term_like(Box::new(paper))
    }
}

impl TermLike for Paper {
    fn width(&self) -> u16 {
        80
    }

    fn move_cursor_up(&self, _: usize) -> io::Result<()> {
        Ok(())
    }

    fn move_cursor_down(&self, _: usize) -> io::Result<()> {
        Ok(())
    }

    fn move_cursor_right(&self, _: usize) -> io::Result<()> {
        Ok(())
    }

    fn move_cursor_left(&self, _: usize) -> io::Result<()> {
        Ok(())
    }

    fn write_line(&self, line: &str) -> io::Result<()> {
        self.write_str(line)
    }

    fn write_str(&self, text: &str) -> io::Result<()> {
        self.0.lock().unwrap().push_str(text);
        Ok(())
    }

    fn clear_line(&self) -> io::Result<()> {
        Ok(())
    }

    fn flush(&self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn one_large_picture_shows_its_name_while_nothing_is_counted() {
    let (paper, bar) = (Paper::default(), hidden(1));
    bar.set_message("large.png");
    show_after(Duration::ZERO, &bar, paper.target());
    // The bar draws from a thread of its own; a minute is for the slowest of machines.
    let drawn = (0..6000).any(|_| {
        thread::sleep(Duration::from_millis(10));
        paper.text().contains("large.png")
    });
    assert!(drawn, "{:?}", paper.text());
}

#[test]
fn a_few_pictures_show_how_many_are_done() {
    let (paper, bar) = (Paper::default(), hidden(3));
    show_after(Duration::ZERO, &bar, paper.target());
    let drawn = (0..6000).any(|_| {
        thread::sleep(Duration::from_millis(10));
        bar.set_position(2);
        paper.text().contains("2/3")
    });
    assert!(drawn, "{:?}", paper.text());
}

#[test]
fn short_work_shows_nothing() {
    let (paper, bar) = (Paper::default(), hidden(100));
    show_after(Duration::from_secs(3600), &bar, paper.target());
    (0..100).for_each(|_| bar.inc(1));
    bar.finish_and_clear();
    assert_eq!(paper.text(), "");
}
