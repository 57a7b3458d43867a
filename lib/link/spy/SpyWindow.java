package waferhand;

import java.awt.BorderLayout;
import java.awt.Dimension;
import java.awt.Window;
import java.awt.event.WindowAdapter;
import java.awt.event.WindowEvent;
import javax.swing.JComponent;
import javax.swing.JDesktopPane;
import javax.swing.JFrame;
import javax.swing.SwingUtilities;
import javax.swing.WindowConstants;

/** A view in the window that lcm-spy has opened around its desktop, else in one of our own. */
final class SpyWindow {
    private SpyWindow() {
    }

    /** `closed` is done when the window closes. */
    static void open(JDesktopPane desktop, String title, JComponent view, Runnable closed) {
        final Window window = desktop == null ? null : SwingUtilities.getWindowAncestor(desktop);
        final JFrame frame = window instanceof JFrame ? (JFrame)window : new JFrame();
        frame.setTitle(title);
        frame.getContentPane().removeAll();
        frame.getContentPane().setLayout(new BorderLayout());
        frame.getContentPane().add(view);
        frame.setDefaultCloseOperation(WindowConstants.DISPOSE_ON_CLOSE);
        frame.addWindowListener(new WindowAdapter() {
            @Override
            public void windowClosed(WindowEvent event) {
                closed.run();
            }
        });
        frame.setMinimumSize(new Dimension(480, 420));
        frame.setSize(1100, 760);
        frame.setVisible(true);
        frame.validate();
    }
}
