package waferhand;

import java.awt.BasicStroke;
import java.awt.Color;
import java.awt.Dimension;
import java.awt.Font;
import java.awt.Graphics;
import java.awt.Graphics2D;
import java.awt.Rectangle;
import java.awt.RenderingHints;
import java.awt.Shape;
import java.awt.event.MouseAdapter;
import java.awt.event.MouseEvent;
import java.awt.geom.Path2D;
import java.util.List;
import java.util.Locale;
import javax.swing.JComponent;
import javax.swing.JPanel;
import javax.swing.Timer;

/** One scan at a time: rho over theta with the fitted circle, the residuals on a scale of their own, and the words. */
final class EdgeScanView extends JPanel {
    private static final long serialVersionUID = 1;
    private static final String KEYS = "← → another scan   End the newest";
    private static final int LOOKS_PER_SECOND = 5;
    private static final Color CIRCLE = ProximityChart.LIMIT;

    private final transient EdgeScan.History history;
    private final Timer timer;
    /** The scan that is shown, or null for the newest. */
    private transient EdgeScan chosen;
    private int mouse = -1;

    EdgeScanView(EdgeScan.History history) {
        super(null);
        this.history = history;
        timer = new Timer(1000 / LOOKS_PER_SECOND, event -> repaint());
        setFocusable(true);
        setBackground(ProximityView.PAPER);
        setPreferredSize(new Dimension(1100, 720));
        bind("LEFT", () -> step(-1));
        bind("RIGHT", () -> step(1));
        bind("END", () -> chosen = null);
        final MouseAdapter listener = new MouseAdapter() {
            @Override
            public void mouseMoved(MouseEvent event) {
                mouse = event.getX();
                repaint();
            }

            @Override
            public void mouseExited(MouseEvent event) {
                mouse = -1;
                repaint();
            }
        };
        addMouseListener(listener);
        addMouseMotionListener(listener);
    }

    void start() {
        requestFocusInWindow();
        timer.start();
    }

    void stop() {
        timer.stop();
    }

    private void bind(String key, Runnable command) {
        SpyWindow.bind(this, key, command);
    }

    /** Steps to an earlier or later scan; after the last one it follows the newest again. */
    void step(int by) {
        final List<EdgeScan> scans = history.scans();
        final int next = Math.max(0, place(scans) + by);
        chosen = next < scans.size() - 1 ? scans.get(next) : null;
    }

    /** A chosen scan that was dropped counts as the oldest. */
    private int place(List<EdgeScan> scans) {
        return chosen == null ? scans.size() - 1 : Math.max(0, scans.indexOf(chosen));
    }

    // ------------------------------------------------------------------------------------------- painting
    @Override
    protected void paintComponent(Graphics graphics) {
        super.paintComponent(graphics);
        final Graphics2D g = (Graphics2D)graphics.create();
        g.setRenderingHint(RenderingHints.KEY_ANTIALIASING, RenderingHints.VALUE_ANTIALIAS_ON);
        g.setRenderingHint(RenderingHints.KEY_TEXT_ANTIALIASING, RenderingHints.VALUE_TEXT_ANTIALIAS_ON);
        g.setFont(new Font(Font.SANS_SERIF, Font.PLAIN, Math.max(11, Math.min(18, getWidth() / 68))));
        final List<EdgeScan> scans = history.scans();
        if (scans.isEmpty()) {
            g.setColor(ProximityChart.FAINT);
            g.drawString("Waiting for the first scan … " + history.lost(), 20, getHeight() / 2);
        } else {
            paintScan(g, scans, place(scans));
        }
        g.dispose();
    }

    private void paintScan(Graphics2D g, List<EdgeScan> scans, int place) {
        final EdgeScan scan = scans.get(place);
        final int line = g.getFontMetrics().getHeight();
        final int left = g.getFontMetrics().stringWidth("−1234.56") + 12;
        final int width = Math.max(20, getWidth() - left - 2 * line);
        final int top = line * (scan.lines.size() + 2);
        final int height = Math.max(20, (getHeight() - top - 5 * line) / 2);
        paintWords(g, scans, place);
        final double[] rim = range(scan);
        final double[] off = residualRange(scan);
        final Rectangle upper = new Rectangle(left, top + line, width, height);
        final Rectangle lower = new Rectangle(left, top + 2 * line + height + line / 2, width, height);
        paintFrame(g, upper, rim, "ρ, mm", false);
        paintFrame(g, lower, off, "residual, µm", true);
        paintRim(g, scan, upper, rim);
        paintResiduals(g, scan, lower, off);
        paintMark(g, scan, upper);
        paintMark(g, scan, lower);
        paintFooter(g, scan, upper, line);
    }

    private void paintWords(Graphics2D g, List<EdgeScan> scans, int place) {
        final EdgeScan scan = scans.get(place);
        final int line = g.getFontMetrics().getHeight();
        g.setColor(ProximityChart.INK);
        g.drawString(String.format(Locale.ROOT, "scan %d of gripper %d at %.3f s, %d of %d   %s", scan.number,
                                   scan.gripper + 1, scan.utime / 1e6, place + 1, scans.size(),
                                   history.lost()),
                     8, line);
        for (int i = 0; i < scan.lines.size(); i++) {
            g.setColor(i > 0 ? ProximityChart.INK : scan.sure ? ProximityChart.GOOD : ProximityChart.LIMIT);
            g.drawString(scan.lines.get(i), 8, line * (i + 2));
        }
    }

    private static double[] range(EdgeScan scan) {
        double low = Double.POSITIVE_INFINITY;
        double high = Double.NEGATIVE_INFINITY;
        for (final double rho : scan.rho) {
            if (!Double.isNaN(rho)) {
                low = Math.min(low, rho);
                high = Math.max(high, rho);
            }
        }
        final double air = Math.max(0.05 * (high - low), 0.01);
        return low <= high ? new double[] {low - air, high + air} : new double[] {0, 1};
    }

    /** The residuals that count fill the scale; those at a notch would flatten them. */
    private static double[] residualRange(EdgeScan scan) {
        double most = 0;
        for (int i = 0; i < scan.taken; i++) {
            most = scan.counts[i] ? Math.max(most, Math.abs(scan.residual[i])) : most;
        }
        return most > 0 ? new double[] {-1.25 * most, 1.25 * most} : new double[] {-1, 1};
    }

    private static double x(Rectangle plot, double degrees) {
        return plot.x + plot.width * degrees / 360;
    }

    private static double y(Rectangle plot, double[] range, double value) {
        return plot.y + plot.height * (range[1] - value) / (range[1] - range[0]);
    }

    private static void paintFrame(Graphics2D g, Rectangle plot, double[] range, String name,
                                   boolean hasAxis) {
        final int line = g.getFontMetrics().getHeight();
        g.setColor(Color.WHITE);
        g.fill(plot);
        final double step = ProximityChart.niceStep(1.4 * line / plot.height * (range[1] - range[0]));
        for (double tick = Math.ceil(range[0] / step) * step; tick <= range[1]; tick += step) {
            final String text = ProximityChart.shortest(tick);
            final int at = (int)Math.round(y(plot, range, tick));
            g.setColor(ProximityChart.GRID);
            g.drawLine(plot.x, at, plot.x + plot.width, at);
            g.setColor(ProximityChart.FAINT);
            g.drawString(text, plot.x - g.getFontMetrics().stringWidth(text) - 6, at + line / 3);
        }
        for (int degrees = 0; degrees <= 360; degrees += 45) {
            final int at = (int)Math.round(x(plot, degrees));
            g.setColor(ProximityChart.GRID);
            g.drawLine(at, plot.y, at, plot.y + plot.height);
            g.setColor(ProximityChart.FAINT);
            final String text = degrees + "°";
            if (hasAxis) {
                g.drawString(text, at - g.getFontMetrics().stringWidth(text) / 2,
                             plot.y + plot.height + line);
            }
        }
        g.setColor(ProximityChart.INK);
        g.drawString(name, plot.x, plot.y - 4);
        g.setColor(ProximityChart.FAINT);
        g.setStroke(new BasicStroke(1));
        g.draw(plot);
    }

    private static void dot(Graphics2D g, Rectangle plot, double[] range, double degrees, double value,
                            int size) {
        if (!Double.isNaN(value) && value >= range[0] && value <= range[1]) {
            g.fillRect((int)Math.round(x(plot, degrees)) - size / 2,
                       (int)Math.round(y(plot, range, value)) - size / 2, size, size);
        }
    }

    private static void paintRim(Graphics2D g, EdgeScan scan, Rectangle plot, double[] range) {
        final Shape clip = g.getClip();
        g.clip(plot);
        g.setColor(ProximityChart.LINE);
        for (int i = 0; i < scan.taken; i++) {
            dot(g, plot, range, scan.theta[i], scan.rho[i], 3);
        }
        if (scan.radius > 0) {
            final Path2D path = new Path2D.Double();
            path.moveTo(x(plot, 0), y(plot, range, scan.circle(0)));
            for (int degrees = 1; degrees <= 360; degrees++) {
                path.lineTo(x(plot, degrees), y(plot, range, scan.circle(degrees)));
            }
            g.setColor(CIRCLE);
            g.setStroke(new BasicStroke(1.6f, BasicStroke.CAP_BUTT, BasicStroke.JOIN_MITER, 10,
                                        new float[] {7, 4}, 0));
            g.draw(path);
        }
        g.setClip(clip);
    }

    private static void paintResiduals(Graphics2D g, EdgeScan scan, Rectangle plot, double[] range) {
        for (int i = 0; i < scan.taken; i++) {
            g.setColor(scan.counts[i] ? ProximityChart.LINE : CIRCLE);
            dot(g, plot, range, scan.theta[i], scan.residual[i], scan.counts[i] ? 2 : 4);
        }
    }

    private static void paintMark(Graphics2D g, EdgeScan scan, Rectangle plot) {
        if (Double.isNaN(scan.markAt)) {
            return;
        }
        final int at = (int)Math.round(x(plot, scan.markAt));
        final String name = (scan.isNotch ? "notch" : "flat") + (scan.sure ? "" : ", not sure");
        final int room = g.getFontMetrics().stringWidth(name) + 5;
        g.setColor(ProximityChart.GOOD);
        g.setStroke(
            new BasicStroke(1.4f, BasicStroke.CAP_BUTT, BasicStroke.JOIN_MITER, 10, new float[] {4, 4}, 0));
        g.drawLine(at, plot.y, at, plot.y + plot.height);
        g.drawString(name, scan.markAt > 180 ? at - room : at + 5, plot.y + plot.height - 5);
    }

    /** Shows the sample below the mouse, or the keys. */
    private void paintFooter(Graphics2D g, EdgeScan scan, Rectangle plot, int line) {
        final double degrees = 360.0 * (mouse - plot.x) / plot.width;
        final int i = mouse >= 0 && degrees >= 0 && degrees <= 360 ? scan.nearest(degrees) : -1;
        g.setColor(ProximityChart.FAINT);
        g.drawString(i < 0
                         ? "● samples   ╌ fitted circle; ■ masked samples   θ in the chuck's frame   " + KEYS
                         : sample(scan, i),
                     8, getHeight() - line / 2);
    }

    private static String sample(EdgeScan scan, int i) {
        final String where = String.format(Locale.ROOT, "sample %d, θ %.2f°: ", i + 1, scan.theta[i]);
        if (Double.isNaN(scan.rho[i])) {
            return where + "no rim, or missing";
        }
        return where + String.format(Locale.ROOT, "ρ %.4f mm", scan.rho[i]) +
            (Double.isNaN(scan.residual[i])
                 ? ""
                 : String.format(Locale.ROOT, ", residual %.2f µm", scan.residual[i])) +
            (scan.counts[i] ? "" : ", masked");
    }
}
