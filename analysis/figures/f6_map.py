# The paper's Figure 6: the fastest implementation over 10 to 100 variables and every fill.
from analysis.figures.f7_map import draw_map
from analysis.style import figure_main


def draw(results):
    return draw_map(results, "Fastest implementation over size and fill, 10 to 100 variables",
                    10, 100)


if __name__ == "__main__":
    figure_main(draw)
