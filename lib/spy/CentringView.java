package waferhand;

import java.awt.BasicStroke;
import java.awt.Color;
import java.awt.Dimension;
import java.awt.Font;
import java.awt.Graphics;
import java.awt.Graphics2D;
import java.awt.Rectangle;
import java.awt.RenderingHints;
import java.awt.geom.Ellipse2D;
import java.util.List;
import java.util.Locale;
import javax.swing.JPanel;
import javax.swing.Timer;

/** One centring at a time: crossings and circles on the blade, the residuals, and the words. */
final class CentringView extends JPanel {
    private static final long serialVersionUID = 1;
    private static final String KEYS = "← → another pass   End the newest";
    private static final int LOOKS_PER_SECOND = 5;
    private static final int NOTCH = 1;
    private static final Color[] PLACES = {ProximityChart.LINE, ProximityChart.LIMIT};

    private final transient CentringPass.History history;
    private final Timer timer;
    /** The centring that is shown, or null for the newest. */
    private transient CentringPass chosen;

    CentringView(CentringPass.History history) {
        super(null);
        this.history = history;
        timer = new Timer(1000 / LOOKS_PER_SECOND, event -> repaint());
        setFocusable(true);
        setBackground(ProximityView.PAPER);
        setPreferredSize(new Dimension(1000, 640));
        SpyWindow.bind(this, "LEFT", () -> step(-1));
        SpyWindow.bind(this, "RIGHT", () -> step(1));
        SpyWindow.bind(this, "END", () -> chosen = null);
    }

    void start() {
        requestFocusInWindow();
        timer.start();
    }

    void stop() {
        timer.stop();
    }

    /** Steps to an earlier or later one; after the last one it follows the newest again. */
    void step(int by) {
        final List<CentringPass> list = history.list();
        final int next = Math.max(0, place(list) + by);
        chosen = next < list.size() - 1 ? list.get(next) : null;
    }

    /** A chosen one that was dropped counts as the oldest. */
    private int place(List<CentringPass> list) {
        return chosen == null ? list.size() - 1 : Math.max(0, list.indexOf(chosen));
    }

    // ------------------------------------------------------------------------------------------- painting
    @Override
    protected void paintComponent(Graphics graphics) {
        super.paintComponent(graphics);
        final Graphics2D g = (Graphics2D)graphics.create();
        g.setRenderingHint(RenderingHints.KEY_ANTIALIASING, RenderingHints.VALUE_ANTIALIAS_ON);
        g.setRenderingHint(RenderingHints.KEY_TEXT_ANTIALIASING, RenderingHints.VALUE_TEXT_ANTIALIAS_ON);
        g.setFont(new Font(Font.SANS_SERIF, Font.PLAIN, Math.max(11, Math.min(18, getWidth() / 68))));
        final List<CentringPass> list = history.list();
        if (list.isEmpty()) {
            g.setColor(ProximityChart.FAINT);
            g.drawString("Waiting for the first pass through beams … " + history.lost(), 20, getHeight() / 2);
        } else {
            paintCentring(g, list, place(list));
        }
        g.dispose();
    }

    private void paintCentring(Graphics2D g, List<CentringPass> list, int place) {
        final CentringPass of = list.get(place);
        final int line = g.getFontMetrics().getHeight();
        final int top = line * (of.lines.size() + 3);
        final int size = Math.max(20, Math.min(getHeight() - top - 3 * line, getWidth() / 2 - 2 * line));
        final Rectangle blade = new Rectangle(line, top, size, size);
        final int left = blade.x + size + g.getFontMetrics().stringWidth("−1234.56") + line;
        final Rectangle residuals = new Rectangle(left, top, Math.max(20, getWidth() - left - line), size);
        paintWords(g, list, place);
        paintBlade(g, of, blade);
        paintResiduals(g, of, residuals);
        g.setColor(ProximityChart.FAINT);
        g.drawString("▲ rim, in   ▼ rim, out   □ notch   × none of the rim   ○ not judged   " + KEYS, 8,
                     getHeight() - line / 2);
    }

    private void paintWords(Graphics2D g, List<CentringPass> list, int place) {
        final CentringPass of = list.get(place);
        final int line = g.getFontMetrics().getHeight();
        g.setColor(ProximityChart.INK);
        g.drawString(String.format(Locale.ROOT,
                                   "pass %d into station %d on gripper %d at %.3f s, %d of %d   %s",
                                   of.told.number, of.told.station + 1, of.told.gripper + 1,
                                   of.told.utime / 1e6, place + 1, list.size(), history.lost()),
                     8, line);
        for (int i = 0; i < of.lines.size(); i++) {
            g.setColor(i > 0 ? ProximityChart.INK : of.sure ? ProximityChart.GOOD : ProximityChart.LIMIT);
            g.drawString(of.lines.get(i), 8, line * (i + 2));
        }
    }

    private static void paintFrame(Graphics2D g, Rectangle plot, String name) {
        g.setColor(Color.WHITE);
        g.fill(plot);
        g.setColor(ProximityChart.INK);
        g.drawString(name, plot.x, plot.y - 4);
        g.setColor(ProximityChart.FAINT);
        g.setStroke(new BasicStroke(1));
        g.draw(plot);
    }

    // ---------------------------------------------------------------------------------------------- blade
    /** The part of the blade that the frame must hold: circles, crossings and the blade's middle, mm to each side of
     * that. */
    private static double reach(CentringPass of) {
        double reach = 10;
        for (int i = 0; i < of.told.centre_count; i++) {
            final centre at = of.told.centres[i];
            reach = Math.max(reach, Math.max(Math.abs(at.x), Math.abs(at.y)) + at.radius);
        }
        for (int k = 0; k < of.told.crossing_count; k++) {
            reach = Math.max(reach, Math.hypot(of.told.crossings[k].x, of.told.crossings[k].y));
        }
        return 1.1 * reach;
    }

    private static void paintBlade(Graphics2D g, CentringPass of, Rectangle plot) {
        paintFrame(g, plot, "on the blade, its x to the right");
        final double scale = plot.width / (2 * reach(of));
        final double x = plot.getCenterX();
        final double y = plot.getCenterY();
        g.drawLine((int)x - 5, (int)y, (int)x + 5, (int)y);
        g.drawLine((int)x, (int)y - 5, (int)x, (int)y + 5);
        for (int i = 0; i < of.told.centre_count; i++) {
            final centre at = of.told.centres[i];
            final double radius = scale * at.radius;
            g.setColor(PLACES[i]);
            g.setStroke(i == 0 ? new BasicStroke(1.6f)
                               : new BasicStroke(1.6f, BasicStroke.CAP_BUTT, BasicStroke.JOIN_MITER, 10,
                                                 new float[] {7, 4}, 0));
            g.draw(new Ellipse2D.Double(x + scale * at.x - radius, y - scale * at.y - radius, 2 * radius,
                                        2 * radius));
        }
        g.setStroke(new BasicStroke(1.6f));
        for (int k = 0; k < of.told.crossing_count; k++) {
            final crossing at = of.told.crossings[k];
            paintMark(g, of, k, (int)Math.round(x + scale * at.x), (int)Math.round(y - scale * at.y));
        }
    }

    /** Crossings that count are filled. Without a place no crossing has a use, whatever the message says. */
    private static void paintMark(Graphics2D g, CentringPass of, int k, int x, int y) {
        final crossing at = of.told.crossings[k];
        final int up = at.edge == 0 ? 1 : -1;
        g.setColor(ProximityChart.INK);
        if (of.told.centre_count == 0) {
            g.drawOval(x - 5, y - 5, 10, 10);
        } else if (at.use == 0) {
            g.fillPolygon(new int[] {x - 6, x + 6, x}, new int[] {y + 4 * up, y + 4 * up, y - 6 * up}, 3);
        } else if (at.use == NOTCH) {
            g.drawRect(x - 5, y - 5, 10, 10);
        } else {
            g.drawLine(x - 5, y - 5, x + 5, y + 5);
            g.drawLine(x - 5, y + 5, x + 5, y - 5);
        }
    }

    // ------------------------------------------------------------------------------------------ residuals
    /** The residuals of the first place's crossings fill the scale; those at a notch would flatten them. */
    private static double most(CentringPass of) {
        double most = 1;
        for (int k = 0; of.told.centre_count > 0 && k < of.told.crossing_count; k++) {
            most = of.told.crossings[k].use == 0 ? Math.max(most, 1.6 * Math.abs(of.residual(0, k))) : most;
        }
        return most;
    }

    private static void paintResiduals(Graphics2D g, CentringPass of, Rectangle plot) {
        paintFrame(g, plot, "residuals, µm");
        final int line = g.getFontMetrics().getHeight();
        final double most = most(of);
        final double step = ProximityChart.niceStep(3.0 * line / plot.height * 2 * most);
        for (double tick = Math.ceil(-most / step) * step; tick <= most; tick += step) {
            final String text = ProximityChart.shortest(tick);
            final int at = (int)Math.round(plot.getCenterY() - plot.height / 2.0 * tick / most);
            g.setColor(ProximityChart.GRID);
            g.drawLine(plot.x, at, plot.x + plot.width, at);
            g.setColor(ProximityChart.FAINT);
            g.drawString(text, plot.x - g.getFontMetrics().stringWidth(text) - 6, at + line / 3);
        }
        for (int k = 0; k < of.told.crossing_count; k++) {
            final int x = plot.x + (int)((k + 0.5) * plot.width / of.told.crossing_count);
            final String name = (of.told.crossings[k].edge == 0 ? "in " : "out ") + (k + 1);
            g.setColor(ProximityChart.FAINT);
            g.drawString(name, x - g.getFontMetrics().stringWidth(name) / 2, plot.y + plot.height + line);
            for (int i = 0; i < of.told.centre_count; i++) {
                paintResidual(g, of.residual(i, k) / most, x, plot, i);
            }
        }
    }

    /** An arrow's head at the side marks a residual beyond the scale. */
    private static void paintResidual(Graphics2D g, double part, int x, Rectangle plot, int place) {
        final double within = Math.max(-0.96, Math.min(0.96, part));
        final int y = (int)Math.round(plot.getCenterY() - plot.height / 2.0 * within);
        g.setColor(PLACES[place]);
        if (Math.abs(part) > 1) {
            final int up = part > 0 ? 1 : -1;
            g.drawPolyline(new int[] {x - 5, x, x + 5}, new int[] {y + 5 * up, y, y + 5 * up}, 3);
        } else if (place == 0) {
            g.fillOval(x - 4, y - 4, 8, 8);
        } else {
            g.drawOval(x - 5, y - 5, 10, 10);
        }
    }
}
