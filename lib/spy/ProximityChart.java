package waferhand;

import java.awt.BasicStroke;
import java.awt.Color;
import java.awt.FontMetrics;
import java.awt.Graphics2D;
import java.awt.Rectangle;
import java.awt.RenderingHints;
import java.awt.Shape;
import java.awt.geom.Path2D;
import java.util.Locale;

/** One value over time beside its limit. The colours are those of Okabe and Ito, which colour-blind people can tell
 * apart. */
final class ProximityChart {
    static final Color INK = new Color(0x22, 0x22, 0x22);
    static final Color FAINT = new Color(0x70, 0x70, 0x70);
    static final Color GRID = new Color(0xe4, 0xe4, 0xe4);
    static final Color LINE = new Color(0x00, 0x72, 0xb2);
    static final Color LIMIT = new Color(0xd5, 0x5e, 0x00);
    static final Color GOOD = new Color(0x00, 0x9e, 0x73);
    /** The colour where the condition holds. */
    private static final Color INSIDE = new Color(0xe6, 0xf4, 0xef);

    private static final String[] NAMES = {"|dr_proj_z|", "|dr_proj_xy|", "n1_proj_n2"};
    private static final String[] UNITS = {" mm", " mm", ""};
    /** The limits of the logarithmic scale, powers of ten. */
    private static final int LOWEST = -2, HIGHEST = 4;

    private final int value;
    private final double limit;
    private final Rectangle plot;
    private final boolean logarithmic;
    private double bottom, top;

    /** Charts one of ProximityHistory's values. The plot is the part within the axes. */
    ProximityChart(int value, double limit, Rectangle plot, boolean logarithmic) {
        this.value = value;
        this.limit = limit;
        this.plot = plot;
        this.logarithmic = logarithmic && value != ProximityHistory.PLANAR;
    }

    /** Whether the condition (6), (7) or (8) holds. */
    static boolean holds(int value, double number, double limit) {
        return value == ProximityHistory.PLANAR ? number > limit : number < limit;
    }

    static String number(int value, double number) {
        if (Double.isNaN(number)) {
            return "–";
        }
        if (value == ProximityHistory.PLANAR) {
            return String.format(Locale.ROOT, "%.6f", number);
        }
        final double size = Math.abs(number);
        final String format = size >= 100 ? "%.1f" : size >= 1e-3 || size == 0 ? "%.3f" : "%.0e";
        return String.format(Locale.ROOT, format, number) + UNITS[value];
    }

    /** `now` is the value in words above the plot, `good` whether its condition holds. */
    void paint(Graphics2D g, ProximityHistory.Strip strip, double now, boolean good) {
        range(strip);
        final int small = g.getFontMetrics().getHeight();
        paintTitle(g, now, good);
        g.setColor(Color.WHITE);
        g.fill(plot);
        paintInside(g);
        paintTicks(g, small);
        final Shape clip = g.getClip();
        g.clipRect(plot.x, plot.y, plot.width, plot.height);
        paintLimit(g);
        paintLine(g, strip);
        g.setClip(clip);
        g.setStroke(new BasicStroke(1));
        g.setColor(FAINT);
        g.drawRect(plot.x, plot.y, plot.width, plot.height);
    }

    // ---------------------------------------------------------------------------------------------- scale
    private void range(ProximityHistory.Strip strip) {
        double low = Double.POSITIVE_INFINITY;
        double high = Double.NEGATIVE_INFINITY;
        for (int x = 0; x < strip.samples.length; x++) {
            if (strip.low[value][x] <= strip.high[value][x]) {
                low = Math.min(low, strip.low[value][x]);
                high = Math.max(high, strip.high[value][x]);
            }
        }
        if (value == ProximityHistory.PLANAR) {
            final double margin = Double.isFinite(limit) && limit < 1 ? 1 - limit : 0.01;
            top = 1 + 0.2 * margin;
            bottom = Math.max(-1.05, Math.min(1 - 2 * margin, low - 0.2 * margin));
        } else if (logarithmic) {
            final double least = positive(limit) ? Math.floor(Math.log10(limit)) - 1 : LOWEST;
            final double most = positive(limit) ? Math.floor(Math.log10(limit)) + 2 : 2;
            bottom = Math.max(LOWEST, Math.min(least, HIGHEST - 2));
            top = Math.min(HIGHEST, Math.max(most, high > 0 ? Math.ceil(Math.log10(high)) : most));
        } else {
            bottom = 0;
            top = positive(limit) ? 2 * limit : high > 0 ? 1.1 * high : 1;
        }
    }

    private static boolean positive(double number) {
        return number > 0 && number < Double.POSITIVE_INFINITY;
    }

    /** The height of a number; beyond the scale it lies just outside the plot. */
    private double y(double number) {
        final double scaled = logarithmic ? Math.log10(Math.max(number, 1e-300)) : number;
        final double part = Math.max(-0.01, Math.min(1.05, (scaled - bottom) / (top - bottom)));
        // What is off a scale of distances at its lower end is 0: it stays in sight.
        final double low = logarithmic ? 2.0 / Math.max(1, plot.height) : -0.01;
        return plot.y + plot.height * (1 - Math.max(low, part));
    }

    // ------------------------------------------------------------------------------------------- painting
    private void paintTitle(Graphics2D g, double now, boolean good) {
        final FontMetrics metrics = g.getFontMetrics();
        final int baseline = plot.y - metrics.getDescent() - 3;
        g.setColor(INK);
        g.drawString(NAMES[value], plot.x, baseline);
        final int size = metrics.getAscent();
        final int left = plot.x + metrics.stringWidth(NAMES[value]) + 2 * size;
        final String limits =
            String.format(Locale.ROOT, "%s %s%s", value == ProximityHistory.PLANAR ? ">" : "<",
                          Double.isNaN(limit) ? "–" : shortest(limit), UNITS[value]);
        final String text = number(value, now);
        // What is not enough room for is left out, the limit first.
        int x = plot.x + plot.width;
        if (x - metrics.stringWidth(text + "  " + limits) > left) {
            x -= metrics.stringWidth(limits);
            g.setColor(LIMIT);
            g.drawString(limits, x, baseline);
            x -= metrics.stringWidth("  ");
        }
        if (x - metrics.stringWidth(text) > left) {
            x -= metrics.stringWidth(text);
            g.setColor(LINE);
            g.drawString(text, x, baseline);
            x -= size / 3;
        }
        if (!Double.isNaN(now) && x > left) {
            mark(g, good, x - size, baseline - size + 2, size - 2);
        }
    }

    /** A tick or a cross. */
    static void mark(Graphics2D g, boolean good, int x, int y, int size) {
        final Path2D path = new Path2D.Double();
        if (good) {
            path.moveTo(x, y + 0.55 * size);
            path.lineTo(x + 0.35 * size, y + 0.9 * size);
            path.lineTo(x + 0.95 * size, y + 0.1 * size);
        } else {
            path.moveTo(x + 0.1 * size, y + 0.15 * size);
            path.lineTo(x + 0.85 * size, y + 0.9 * size);
            path.moveTo(x + 0.85 * size, y + 0.15 * size);
            path.lineTo(x + 0.1 * size, y + 0.9 * size);
        }
        g.setColor(good ? GOOD : LIMIT);
        g.setStroke(new BasicStroke(Math.max(2f, size / 6f), BasicStroke.CAP_ROUND, BasicStroke.JOIN_ROUND));
        g.draw(path);
    }

    private void paintInside(Graphics2D g) {
        if (Double.isNaN(limit)) {
            return;
        }
        final int at = (int)Math.round(Math.max(plot.y, Math.min(plot.y + plot.height, y(limit))));
        g.setColor(INSIDE);
        if (value == ProximityHistory.PLANAR) {
            g.fillRect(plot.x, plot.y, plot.width, at - plot.y);
        } else {
            g.fillRect(plot.x, at, plot.width, plot.y + plot.height - at);
        }
    }

    private void paintTicks(Graphics2D g, int height) {
        final double least = 1.3 * height / Math.max(1, plot.height) * (top - bottom);
        final double step = logarithmic ? Math.max(1, Math.ceil(least)) : niceStep(least);
        for (double tick = Math.ceil(bottom / step - 1e-9) * step; tick <= top + 1e-9 * step; tick += step) {
            final double number = logarithmic ? Math.pow(10, tick) : tick;
            final int at = (int)Math.round(plot.y + plot.height * (1 - (tick - bottom) / (top - bottom)));
            g.setColor(GRID);
            g.drawLine(plot.x, at, plot.x + plot.width, at);
            g.setColor(FAINT);
            final String text = shortest(number);
            final FontMetrics metrics = g.getFontMetrics();
            g.drawString(text, plot.x - metrics.stringWidth(text) - 6, at + metrics.getAscent() / 2 - 1);
        }
    }

    /** 1, 2 or 5 times a power of ten, not below `least`. */
    static double niceStep(double least) {
        final double power = Math.pow(10, Math.floor(Math.log10(Math.max(least, 1e-300))));
        for (final double step : new double[] {1, 2, 5}) {
            if (step * power >= least) {
                return step * power;
            }
        }
        return 10 * power;
    }

    /** Writes a number without trailing zeros. */
    static String shortest(double number) {
        final String text = String.format(Locale.ROOT, "%.6f", number);
        return text.replaceFirst("\\.?0+$", "").replaceFirst("^-0$", "0");
    }

    private void paintLimit(Graphics2D g) {
        if (!Double.isNaN(limit)) {
            g.setColor(LIMIT);
            g.setStroke(new BasicStroke(1.6f, BasicStroke.CAP_BUTT, BasicStroke.JOIN_MITER, 10,
                                        new float[] {7, 4}, 0));
            final int at = (int)Math.round(y(limit));
            g.drawLine(plot.x, at, plot.x + plot.width, at);
        }
    }

    private void paintLine(Graphics2D g, ProximityHistory.Strip strip) {
        final Path2D path = new Path2D.Double();
        int before = -1;
        for (int x = 0; x < strip.samples.length; x++) {
            if (strip.samples[x] == 0) {
                continue;
            }
            if (before >= 0 && strip.same[x]) {
                segment(path, before, strip.last[value][before], x, strip.first[value][x]);
            }
            segment(path, x, strip.low[value][x], x, strip.high[value][x]);
            before = x;
        }
        g.setColor(LINE);
        g.setStroke(new BasicStroke(2f, BasicStroke.CAP_ROUND, BasicStroke.JOIN_ROUND));
        g.setRenderingHint(RenderingHints.KEY_STROKE_CONTROL, RenderingHints.VALUE_STROKE_PURE);
        g.draw(path);
    }

    private void segment(Path2D path, int fromColumn, double from, int toColumn, double to) {
        if (!Double.isNaN(from) && !Double.isNaN(to)) {
            path.moveTo(plot.x + fromColumn + 0.5, y(from));
            path.lineTo(plot.x + toColumn + 0.5, y(to));
        }
    }
}
