/* Doubles as decimal digits, exactly and fast. */
#ifndef WH_TEXT_DIGITS_H
#define WH_TEXT_DIGITS_H

/* Room for any double, with its terminator. */
#define WH_DIGITS 40

/* Writes the fewest digits, from 15 to 17, that read back as an equal double: the text of printf's "%.15g",
 * else "%.16g", else "%.17g", without printf's cost. Any value; infinities and NaN as printf writes them.
 * Cost: 0.05 us from 1e-15 to 1e15, 1 us beyond. */
void wh_digits(double value, char digits[WH_DIGITS]);

#endif
