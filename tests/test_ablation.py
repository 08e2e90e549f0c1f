from index.methods import METHODS
from service.evaluation.ablation import ablations


def blocks(without: str = "") -> tuple[str, ...]:
    return tuple(block.name for block in METHODS["fused"].blocks if block.name != without)


def test_each_part_of_fused_is_left_out_once_with_and_once_without_the_second_stage() -> None:
    found = {
        m.name: (tuple(block.name for block in m.blocks), m.refined) for m in ablations(METHODS["fused"])
    }
    first = METHODS["fused"].refined
    assert found == {
        "fused: first stage": (blocks(), 0),
        "fused, no log-hks": (blocks("log-hks"), first),
        "fused: first stage, no log-hks": (blocks("log-hks"), 0),
        "fused, no colour-histogram": (blocks("colour-histogram"), first),
        "fused: first stage, no colour-histogram": (blocks("colour-histogram"), 0),
        "fused, no colour-curves": (blocks("colour-curves"), first),
        "fused: first stage, no colour-curves": (blocks("colour-curves"), 0),
    }


def test_a_method_of_one_stage_loses_its_blocks_alone() -> None:
    assert [method.name for method in ablations(METHODS["chks"])] == [
        "chks, no hks-0",
        "chks, no hks-0.05",
        "chks, no hks-0.1",
    ]


def test_what_stays_keeps_its_weights() -> None:
    for method in ablations(METHODS["fused"]):
        assert set(method.blocks) <= set(METHODS["fused"].blocks)
