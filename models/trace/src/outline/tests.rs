mod windows;
mod report;
