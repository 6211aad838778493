// A double is m 2^e with a whole m. Its decimal digits are those of m 10^s 2^e for the s that makes this a number of as
// many digits as asked; with s from 0 to 38 the product is a whole number of 192 bits, from which the binary places are
// shifted out and rounded, half to even, without any error.
#include "base/digits.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

enum { MANTISSA = 53, MOST = 17, STEP = 19, SCALES = 2 * STEP };  // 10^19 is the largest in 64 bits

typedef unsigned __int128 wide;

static const uint64_t tens[STEP + 1] = {1u,
                                        10u,
                                        100u,
                                        1000u,
                                        10000u,
                                        100000u,
                                        1000000u,
                                        10000000u,
                                        100000000u,
                                        1000000000u,
                                        10000000000u,
                                        100000000000u,
                                        1000000000000u,
                                        10000000000000u,
                                        100000000000000u,
                                        1000000000000000u,
                                        10000000000000000u,
                                        100000000000000000u,
                                        1000000000000000000u,
                                        10000000000000000000u};

// round(m 10^s 2^-shift), half to even; the result is known to fit
static uint64_t scaled(uint64_t m, int s, int shift)
{
    wide part = (wide)m * tens[s < STEP ? s : STEP];
    uint64_t more = tens[s < STEP ? 0 : s - STEP];
    // part * more = high 2^64 + low
    wide bottom = (wide)(uint64_t)part * more, high = (wide)(uint64_t)(part >> 64) * more + (bottom >> 64);
    uint64_t low = (uint64_t)bottom;
    if (shift <= 0)
        return low << -shift;  // nothing behind the point, and no more than 64 bits
    wide whole, rest, half;
    if (shift < 64) {
        whole = (high << (64 - shift)) | (low >> shift);
        rest = low & (((uint64_t)1 << shift) - 1);
        half = (wide)1 << (shift - 1);
    } else if (shift == 64) {
        whole = high;
        rest = low;
        half = (wide)1 << 63;
    } else {
        whole = high >> (shift - 64);
        // what is shifted out, a last bit standing for all that is not 0 below it
        rest = ((high & (((wide)1 << (shift - 64)) - 1)) << 1) | (low != 0);
        half = (wide)1 << (shift - 64);
    }
    return (uint64_t)whole + (rest > half || (rest == half && (whole & 1)));
}

// the digits d of |value| = 0.d 10^power; false: out of reach
static bool find_digits(double value, int digits, uint64_t *d, int *power)
{
    int e;
    uint64_t m = (uint64_t)(frexp(fabs(value), &e) * 0x1p53);
    int guess = (int)ceil((e - 1) * 0.30102999566398120 - 1e-9);  // 10^guess is about 2^(e - 1), at most |value| 10
    for (*power = guess; *power <= guess + 1; ++*power) {
        int s = digits - *power, shift = MANTISSA - e;
        if (s < 0 || s > SCALES || shift > 126 || shift < -11)
            return false;
        *d = scaled(m, s, shift);
        if (*d < tens[digits - 1])
            return false;
        if (*d < tens[digits])
            return true;
        // rounded up to the next power of ten, or one more digit before the point than guessed
    }
    return false;
}

// the digits with the point behind the first `before` of them
static char *put_fixed(char *at, const char *text, int count, int before)
{
    if (before <= 0) {
        *at++ = '0', *at++ = '.';
        memset(at, '0', (size_t)-before);
        at += -before;
        before = 0;
    } else {
        for (int k = 0; k < before; k++)
            *at++ = k < count ? text[k] : '0';
        if (count > before)
            *at++ = '.';
    }
    if (count > before) {
        memcpy(at, text + before, (size_t)(count - before));
        at += count - before;
    }
    return at;
}

bool dem_digits_print(char *text, size_t size, double value, int digits)
{
    uint64_t d;
    int power;
    if (size < DEM_DIGITS_TEXT || digits < 1 || digits > MOST || !isfinite(value) || value == 0 ||
        !find_digits(value, digits, &d, &power))
        return false;
    char plain[MOST];
    int count = digits;
    for (int k = digits; k-- > 0; d /= 10)
        plain[k] = (char)('0' + d % 10);
    while (count > 1 && plain[count - 1] == '0')
        count--;
    char *at = text;
    if (value < 0)
        *at++ = '-';
    int exponent = power - 1;
    if (exponent >= -4 && exponent < digits) {
        at = put_fixed(at, plain, count, power);
    } else {
        at = put_fixed(at, plain, count, 1);
        *at++ = 'e';
        *at++ = exponent < 0 ? '-' : '+';
        exponent = exponent < 0 ? -exponent : exponent;
        *at++ = (char)('0' + exponent / 10);  // less than 100 by far
        *at++ = (char)('0' + exponent % 10);
    }
    *at = 0;
    return true;
}
