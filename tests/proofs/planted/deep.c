void planted_fill(unsigned char *bytes, unsigned n);
unsigned t3r_planted(unsigned n);

unsigned t3r_planted(unsigned n)
{
    unsigned char bytes[40000];
    planted_fill(bytes, n);
    return bytes[n];
}
