/* Not by the repository's .clang-format. */
int planted( int x ){ return x; }
