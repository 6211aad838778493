#define _GNU_SOURCE
#include "base/text.h"

#include <ctype.h>
#include <errno.h>
#include <locale.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/digits.h"

enum {
    EXACT_DIGITS = 15,
    EXACT_POWER = 22,
    MOST_DIGITS = 19,
    TWO_WORDS_POWER = 27,
    LOSSLESS_DIGITS = 17,
    NUMBER_TEXT = 64
};

static const double powers_of_ten[EXACT_POWER + 1] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                      1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                      1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

// strtod in the C locale, for what the exact path below cannot do; `text` is 0-terminated by a copy
static const char *parse_slowly(const char *text, const char *end, double *value)
{
    size_t length = 0;
    while (text + length < end && (isalnum((unsigned char)text[length]) || strchr("+-.", text[length])))
        length++;
    char short_copy[NUMBER_TEXT];
    char *copy = length < sizeof short_copy ? short_copy : malloc(length + 1);
    if (!copy)
        return NULL;
    memcpy(copy, text, length);
    copy[length] = 0;
    locale_t plain = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    char *stop = copy;
    if (plain) {
        *value = strtod_l(copy, &stop, plain);
        freelocale(plain);
    }
    size_t used = (size_t)(stop - copy);
    if (copy != short_copy)
        free(copy);
    return used ? text + used : NULL;
}

static const uint64_t powers_of_five[TWO_WORDS_POWER + 1] = {1,
                                                             5,
                                                             25,
                                                             125,
                                                             625,
                                                             3125,
                                                             15625,
                                                             78125,
                                                             390625,
                                                             1953125,
                                                             9765625,
                                                             48828125,
                                                             244140625,
                                                             1220703125,
                                                             6103515625,
                                                             30517578125,
                                                             152587890625,
                                                             762939453125,
                                                             3814697265625,
                                                             19073486328125,
                                                             95367431640625,
                                                             476837158203125,
                                                             2384185791015625,
                                                             11920928955078125,
                                                             59604644775390625,
                                                             298023223876953125,
                                                             1490116119384765625,
                                                             7450580596923828125};

// m 10^power, correctly rounded: product or quotient of whole numbers in 128 bits, what is left over as a last bit that
// is set. |power| <= TWO_WORDS_POWER, so that 5^|power| < 2^63; m > 0
static double scale_exactly(uint64_t m, int power)
{
    uint64_t fives = powers_of_five[abs(power)], bits;
    int exponent = power; // of two
    bool rest;
    if (power < 0) {
        // both with their first bit set: the quotient has 63 or 64 bits
        int shift = __builtin_clzll(m), other = __builtin_clzll(fives);
        unsigned __int128 wide = (unsigned __int128)(m << shift) << 63;
        fives <<= other;
        bits = (uint64_t)(wide / fives);
        rest = (unsigned __int128)bits * fives != wide;
        exponent += other - shift - 63;
    } else {
        unsigned __int128 wide = (unsigned __int128)m * fives;
        uint64_t high = (uint64_t)(wide >> 64);
        int shift = high ? 64 - __builtin_clzll(high) : 0; // to 64 bits
        bits = (uint64_t)(wide >> shift);
        rest = (unsigned __int128)bits << shift != wide;
        exponent += shift;
    }
    int spare = 9 - __builtin_clzll(bits); // to 55 bits: two more than a double has
    if (spare > 0) {
        rest |= bits << (64 - spare) != 0;
        bits >>= spare;
        exponent += spare;
    }
    uint64_t two = (uint64_t)(1023 + exponent) << 52;
    double scale;
    memcpy(&scale, &two, sizeof scale);
    return (double)(bits | rest) * scale;
}

// Digits up to 15 and a power of ten up to 22 are exact in a double, so one multiplication or division rounds
// correctly (Clinger 1990). Digits up to 19 and a power up to 27 (numbers printed without loss) are exact in whole
// numbers. Everything else goes to strtod.
const char *dem_parse_double(const char *text, const char *end, double *value)
{
    const char *p = text;
    bool negative = false;
    if (p < end && (*p == '-' || *p == '+'))
        negative = *p++ == '-';
    uint64_t mantissa = 0;
    int digits = 0, point = 0;
    bool any = false, behind = false;
    for (; p < end && ((*p >= '0' && *p <= '9') || (*p == '.' && !behind)); p++) {
        if (*p == '.') {
            behind = true;
            continue;
        }
        any = true;
        if (mantissa || *p != '0')
            digits++;
        if (digits > MOST_DIGITS)
            return parse_slowly(text, end, value);
        mantissa = mantissa * 10 + (uint64_t)(*p - '0');
        point -= behind;
    }
    if (!any)
        return parse_slowly(text, end, value);
    if (p < end && (*p == 'e' || *p == 'E')) {
        const char *q = p + 1;
        bool down = false;
        if (q < end && (*q == '-' || *q == '+'))
            down = *q++ == '-';
        if (q < end && *q >= '0' && *q <= '9') {
            int exponent = 0;
            for (; q < end && *q >= '0' && *q <= '9'; q++)
                if (exponent < 10000)
                    exponent = exponent * 10 + (*q - '0');
            point += down ? -exponent : exponent;
            p = q;
        }
    }
    if (p < end && isalnum((unsigned char)*p))
        return parse_slowly(text, end, value); // hexadecimal and other rarities: strtod decides
    double result = (double)mantissa;
    if (mantissa && (digits > EXACT_DIGITS || point > EXACT_POWER || point < -EXACT_POWER)) {
        if (point > TWO_WORDS_POWER || point < -TWO_WORDS_POWER)
            return parse_slowly(text, end, value);
        result = scale_exactly(mantissa, point);
    } else if (mantissa)
        result = point < 0 ? result / powers_of_ten[-point] : result * powers_of_ten[point];
    *value = negative ? -result : result;
    return p;
}

const char *dem_parse_long(const char *text, const char *end, long *value)
{
    const char *p = text;
    bool negative = false;
    if (p < end && (*p == '-' || *p == '+'))
        negative = *p++ == '-';
    if (p >= end || *p < '0' || *p > '9')
        return NULL;
    long result = 0;
    for (; p < end && *p >= '0' && *p <= '9'; p++)
        if (__builtin_mul_overflow(result, 10L, &result) || __builtin_add_overflow(result, (long)(*p - '0'), &result))
            return NULL;
    *value = negative ? -result : result;
    return p;
}

void dem_buffer_bytes(dem_buffer *buffer, const void *bytes, size_t size)
{
    if (buffer->failed)
        return;
    if (buffer->capacity - buffer->size < size + 1) {
        size_t wanted = buffer->capacity + buffer->capacity / 2 + size + 256;
        char *grown = wanted > buffer->size ? realloc(buffer->data, wanted) : NULL;
        if (!grown) {
            buffer->failed = true;
            return;
        }
        buffer->data = grown;
        buffer->capacity = wanted;
    }
    if (size)
        memcpy(buffer->data + buffer->size, bytes, size);
    buffer->size += size;
    buffer->data[buffer->size] = 0;
}

void dem_buffer_text(dem_buffer *buffer, const char *text)
{
    dem_buffer_bytes(buffer, text, strlen(text));
}

void dem_buffer_print(dem_buffer *buffer, const char *format, ...)
{
    char text[1024];
    va_list args;
    va_start(args, format);
    int length = vsnprintf(text, sizeof text, format, args);
    va_end(args);
    if (length < 0)
        buffer->failed = true;
    else if ((size_t)length < sizeof text)
        dem_buffer_bytes(buffer, text, (size_t)length);
    else {
        char *copy = malloc((size_t)length + 1);
        if (!copy) {
            buffer->failed = true;
            return;
        }
        va_start(args, format);
        vsnprintf(copy, (size_t)length + 1, format, args);
        va_end(args);
        dem_buffer_bytes(buffer, copy, (size_t)length);
        free(copy);
    }
}

char *dem_format_double(char *text, size_t size, double value, int digits)
{
    if (dem_digits_print(text, size, value, digits))
        return text;
    snprintf(text, size, "%.*g", digits, value);
    for (char *p = text; *p; p++)
        if (*p == ',')
            *p = '.';
    return text;
}

void dem_buffer_number(dem_buffer *buffer, double value, int digits)
{
    char text[NUMBER_TEXT];
    dem_buffer_text(buffer, dem_format_double(text, sizeof text, value, digits));
}

void dem_buffer_shortest(dem_buffer *buffer, double value)
{
    char text[NUMBER_TEXT] = "nan";
    double back = NAN;
    for (int digits = EXACT_DIGITS; digits <= LOSSLESS_DIGITS && !isnan(value) && back != value; digits++) {
        dem_format_double(text, sizeof text, value, digits);
        dem_parse_double(text, text + strlen(text), &back);
    }
    dem_buffer_text(buffer, text);
}

void dem_buffer_release(dem_buffer *buffer)
{
    free(buffer->data);
    *buffer = (dem_buffer){0};
}
