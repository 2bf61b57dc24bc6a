int planted_next(void);

int planted_next(void)
{
    static int calls;
    return ++calls;
}
