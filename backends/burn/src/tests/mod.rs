mod graph;
mod operations;
