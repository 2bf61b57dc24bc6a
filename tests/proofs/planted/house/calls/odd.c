/* The other one. */
int even(unsigned n);
int odd(unsigned n);
int odd(unsigned n)
{
    return n == 0 ? 0 : even(n - 1);
}
