# Set-up times of the largest scene, as bars.
import matplotlib.pyplot as plt


def draw(tables, view):
    rows = tables["setups"].dropna(subset=["setup_us"])
    if rows.empty:
        return {}
    scene = rows.scene.iloc[-1]
    mine = rows[rows.scene == scene].sort_values("setup_us")
    figure, axes = plt.subplots(figsize=(7, 0.3 * len(mine) + 1))
    axes.barh(mine.implementation, mine.setup_us)
    axes.set_xscale("log")
    axes.set_xlabel("µs")
    axes.set_title(f"Setting {scene} up, {view.context['cpu_model']}")
    return {"setups": figure}
