package waferhand;

import java.awt.BorderLayout;
import java.awt.Dimension;
import java.awt.Window;
import java.awt.event.ActionEvent;
import java.awt.event.WindowAdapter;
import java.awt.event.WindowEvent;
import javax.swing.AbstractAction;
import javax.swing.JComponent;
import javax.swing.JDesktopPane;
import javax.swing.JFrame;
import javax.swing.KeyStroke;
import javax.swing.SwingUtilities;
import javax.swing.WindowConstants;

/** A view in the window that lcm-spy has opened around its desktop, or in a window of our own. */
final class SpyWindow {
    private SpyWindow() {
    }

    /** A key of the view's window does the command and draws the view anew. */
    static void bind(JComponent view, String key, Runnable command) {
        view.getInputMap(JComponent.WHEN_IN_FOCUSED_WINDOW).put(KeyStroke.getKeyStroke(key), key);
        view.getActionMap().put(key, new AbstractAction() {
            private static final long serialVersionUID = 1;

            @Override
            public void actionPerformed(ActionEvent event) {
                command.run();
                view.repaint();
            }
        });
    }

    /** `closed` is called when the window closes. */
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
