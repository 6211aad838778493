// A library that is no plug-in.
int not_a_law(void);
int not_a_law(void)
{
    return 1;
}
